#include "coordinator/controller.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "base/archive.hpp"
#include "base/error.hpp"
#include "coordinator/coupling/contact.hpp"
#include "coordinator/coupling/horizon.hpp"
#include "coordinator/coupling/roles.hpp"

namespace abut {

namespace {

constexpr double clock_tolerance = 1.0e-9;  // of a window: the end is reached
// of a substep: an event so near to the window's begin is there
constexpr double event_tolerance = 1.0e-4;
constexpr double force_floor = 1.0e-9;  // of the largest contact force: less is no compression
constexpr int most_events = 8;          // per window; more is chatter
constexpr int most_halvings = 20;

}  // namespace

Controller::Controller(const Scene& scene, std::vector<Subdomain*> bodies,
                       std::vector<Observer*> observers, const std::atomic<bool>* interrupted)
    : scene_(scene),
      bodies_(std::move(bodies)),
      observers_(std::move(observers)),
      interrupted_(interrupted),
      coupling_(make_coupling(scene, bodies_)),
      joints_(coupling_.joints()),
      schwarz_(make_schwarz(scene.schwarz)),
      anchor_(scene.time.begin),
      time_(scene.time.begin) {
  end_.status = "completed";
  reports_.resize(coupling_.interfaces.size());
}

RunEnd Controller::run() {
  const auto began = std::chrono::steady_clock::now();
  auto wall = [began] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  };
  try {
    observe_start();
    while (running()) {
      if (!fly_free()) step_window();
    }
    if (interrupted_ != nullptr && interrupted_->load()) end_.status = "interrupted";
    return finish(wall());  // asks the bodies for their states: they may be lost there as well
  } catch (const RunError& error) {
    const bool interrupted = interrupted_ != nullptr && interrupted_->load();
    give_up(error, interrupted, wall());
    if (!interrupted) throw;
    return end_;
  }
}

/// The bodies are in the middle of a solve, or gone: there is no state to hash.
void Controller::give_up(const RunError& error, bool interrupted, double wall_seconds) {
  end_.status = "interrupted";  // a wait that the user has ended is no failure
  if (!interrupted)
    fail(time_, (error.where.empty() ? "" : error.where + ": ") + error.what_is_wrong);
  end_.compute_seconds = bodies_.compute_seconds();
  end_.wall_seconds = wall_seconds;
  end_.exchanges = bodies_.exchanges();
  end_.time = time_;
  for (Observer* observer : observers_) {
    try {
      observer->on_end(end_);
    } catch (const RunError&) {  // a full disk again: the first error is the one to tell,
    }                            // and the other observers still write what they can
  }
}

bool Controller::running() const {
  if (end_.status != "completed" || (interrupted_ != nullptr && interrupted_->load())) return false;
  return time_ < scene_.time.end - clock_tolerance * scene_.time.window;
}

void Controller::observe_start() {
  RunStart start{scene_.time.begin, scene_.time.end, {}, {}};
  for (int b = 0; b < bodies_.count(); ++b) start.bodies.push_back(&bodies_.describe(b));
  for (const Interface& i : coupling_.interfaces) {
    start.interfaces.push_back({i.name,
                                {i.sides[0].body, i.sides[1].body},
                                {i.sides[0].port, i.sides[1].port},
                                i.reference_gap});
  }
  for (Observer* observer : observers_) observer->on_start(start);
  const TimeWindow instant{0, time_, time_};
  bodies_.save_all();
  prepare(instant, 1, Sampling::substeps);
  if (std::optional<Failed> failed = bodies_.advance_all())
    return fail(failed->time, failed->detail);
  fill_reports(nullptr);
  for (Observer* observer : observers_)
    observer->on_window({instant, bodies_.responses(), reports_});
}

bool Controller::fly_free() {
  const bool waits =
      std::any_of(coupling_.interfaces.begin(), coupling_.interfaces.end(),
                  [](const Interface& i) { return i.closed || i.release_impulse != 0.0; });
  if (waits || std::exchange(grounded_, false)) return false;
  const double window = scene_.time.window;
  const double horizon = free_flight_horizon(coupling_.interfaces, bodies_);
  const double left = scene_.time.end - time_;
  const double whole = std::floor(std::min(horizon, left) / window + clock_tolerance);
  const int windows = static_cast<int>(std::min<double>(whole, flight_limit_));
  if (windows < 1) return false;
  TimeWindow flight = next_window();
  flight.end = anchor_ + static_cast<double>(since_ + windows) * window;
  if (std::abs(flight.end - scene_.time.end) < clock_tolerance * window)
    flight.end = scene_.time.end;
  bodies_.save_all();
  prepare(flight, windows * scene_.output.records_per_window, Sampling::records);
  if (std::optional<Failed> failed = bodies_.advance_all()) {
    fail(failed->time, failed->detail);
    return true;
  }
  if (!stayed_apart(coupling_.interfaces, bodies_)) {
    bodies_.restore_all();
    grounded_ = true;
    flight_limit_ = std::max(1, windows / 4);  // the bound was wrong: trust it less for a while
    return false;
  }
  fill_reports(nullptr);
  for (Observer* observer : observers_)
    observer->on_window({flight, bodies_.responses(), reports_});
  end_.windows += windows;
  since_ += windows;
  time_ = flight.end;
  events_here_ = 0;
  flight_limit_ = std::min(most_windows_at_once, 2 * flight_limit_);
  return true;
}

void Controller::step_window() {
  TimeWindow window = next_window();
  apply_criteria_at_start(window);
  bodies_.save_all();
  while (running()) {
    const Attempt& attempt = advance(window);
    if (attempt.failed || !attempt.converged()) {
      if (!handle_trouble(attempt, window)) return;
      if (attempt.failed || scene_.schwarz.on_nonconvergence != "accept") continue;
    }
    const std::vector<Event> events = first_events(window);
    if (events.empty()) return accept(window, attempt);
    if (++events_here_ > most_events) return step_chattering(window);
    const double cut = events.front().state;
    if (cut >= window.end) {  // a touch at the very end changes nothing before it
      accept(window, attempt);
      for (const Event& event : events) apply(event);
      return;
    }
    bodies_.restore_all();
    if (cut - window.begin >= event_tolerance * shortest_step()) {
      const TimeWindow part{window.index, window.begin, cut};
      const Attempt& shorter = advance(part);
      if (shorter.failed) return fail(shorter.failed->time, shorter.failed->detail);
      accept(part, shorter);
      for (const Event& event : events) apply(event);
      return;
    }
    for (const Event& event : events) apply(event);
  }
}

void Controller::step_chattering(const TimeWindow& window) {
  // No more events are located, every substep decides for itself. Leaving the sides free instead
  // would let them overlap, and closing an overlap later would make energy out of nothing.
  std::vector<int> touching;
  for (std::size_t i = 0; i < coupling_.interfaces.size(); ++i) {
    Interface& interface = coupling_.interfaces[i];
    if (!coupling_.rules[i].located()) continue;
    if (!interface.closed) {
      const std::optional<Closing> closing = overlap_criterion(interface, bodies_);
      if (!closing) continue;
      close(static_cast<int>(i), window.begin, closing->speed);
    }
    interface.bilateral = false;
    touching.push_back(static_cast<int>(i));
  }
  emit(
      RunEvent::Kind::warning, window.begin,
      touching.empty() ? "" : coupling_.interfaces[static_cast<std::size_t>(touching[0])].name,
      fmt::format("contact changed more than {} times within a window: in one window every substep "
                  "decides for itself",
                  most_events));
  bodies_.restore_all();
  TimeWindow part = window;
  Attempt attempt = advance(part);
  while (attempt.failed || !attempt.converged()) {
    // fewer substeps at once, fewer kinks in the map that is iterated
    const double fewer = std::floor(0.5 * part.length() / longest_step() + 0.25) * longest_step();
    if (!attempt.failed && fewer > 0.0 && fewer < 0.75 * part.length()) {
      part.end = part.begin + fewer;
      bodies_.restore_all();
    } else {
      if (!handle_trouble(attempt, part)) return;
      if (!attempt.failed && scene_.schwarz.on_nonconvergence == "accept") break;
    }
    attempt = advance(part);
  }
  for (int i : touching) coupling_.interfaces[static_cast<std::size_t>(i)].bilateral = true;
  accept(part, attempt);
  for (int i : touching) {
    Interface& interface = coupling_.interfaces[static_cast<std::size_t>(i)];
    const Waveform& trace = trace_of(bodies_, interface.kinematic_side());
    const double force = -interface.normal_of(interface.kinematic) * trace.f.back();
    if (force <= force_floor * interface.force_scale) apply({i, false, part.end, part.end, 0.0});
  }
}

const Controller::Partition& Controller::partition() {
  bool same = partition_.roles.size() == coupling_.interfaces.size() &&
              !(partition_.islands.empty() && partition_.free.empty());
  partition_.roles.resize(coupling_.interfaces.size(), -1);
  for (std::size_t i = 0; i < coupling_.interfaces.size(); ++i) {
    const Interface& interface = coupling_.interfaces[i];
    const int role = interface.closed ? interface.kinematic : -1;
    same = same && partition_.roles[i] == role;
    partition_.roles[i] = role;
  }
  if (same) return partition_;
  partition_.islands = find_islands(joints_, bodies_.count());
  partition_.free.resize(static_cast<std::size_t>(bodies_.count()));
  std::iota(partition_.free.begin(), partition_.free.end(), 0);
  for (const Island& island : partition_.islands) {
    for (const std::vector<int>& level : island.levels) {
      for (int body : level) std::erase(partition_.free, body);
    }
  }
  return partition_;
}

const Controller::Attempt& Controller::advance(const TimeWindow& window) {
  attempt_.failed.reset();
  attempt_.reports.clear();
  prepare(window, is_whole(window) ? scene_.output.records_per_window : 1, Sampling::substeps);
  for (const Island& island : partition().islands) {
    std::variant<SchwarzReport, Failed> result = schwarz_.solve(window, island, joints_, bodies_);
    if (Failed* failed = std::get_if<Failed>(&result); failed != nullptr) {
      attempt_.failed = std::move(*failed);
      return attempt_;
    }
    attempt_.reports.push_back(std::get<SchwarzReport>(result));
  }
  attempt_.failed = bodies_.advance(partition_.free);
  return attempt_;
}

double Controller::longest_step() const {
  double longest = 0.0;
  for (int b = 0; b < bodies_.count(); ++b) longest = std::max(longest, bodies_.describe(b).step);
  return longest > 0.0 ? longest : scene_.time.window;
}

bool Controller::Attempt::converged() const {
  return std::all_of(reports.begin(), reports.end(),
                     [](const SchwarzReport& r) { return r.converged; });
}

bool Controller::handle_trouble(const Attempt& attempt, TimeWindow& window) {
  std::string text;
  if (attempt.failed) {
    text = fmt::format("{}: {}", to_string(attempt.failed->cause), attempt.failed->detail);
  } else {
    double residual = 0.0;
    int iterations = 0;
    for (const SchwarzReport& r : attempt.reports) {
      if (r.converged) continue;
      residual = std::max(residual, r.residual.largest());
      iterations = r.iterations;
    }
    text = fmt::format(
        "Schwarz iteration not converged after {} iterations: residual {:.3g}, tolerance {:.3g}",
        iterations, residual, scene_.schwarz.tolerance);
  }
  const std::string& policy = scene_.schwarz.on_nonconvergence;
  if (policy == "accept" && !attempt.failed) {
    emit(RunEvent::Kind::warning, window.begin, "", text + "; accepted as the scene says");
    return true;
  }
  if (policy == "halve" && halvings_ < most_halvings) {
    ++halvings_;
    window.end = window.begin + 0.5 * window.length();
    emit(RunEvent::Kind::warning, window.begin, "", text + "; the window is halved");
    bodies_.restore_all();
    return true;
  }
  constexpr const char* remedy = "; raise schwarz.max_iterations or choose another accelerator";
  fail(window.begin, attempt.failed ? text : text + remedy);
  return false;
}

void Controller::accept(const TimeWindow& window, const Attempt& attempt) {
  for (const Island& island : partition_.islands) schwarz_.accept(island);
  fill_reports(&attempt);
  for (std::size_t i = 0; i < coupling_.interfaces.size(); ++i) {
    Interface& interface = coupling_.interfaces[i];
    interface.release_impulse = 0.0;
    if (!interface.closed) continue;
    interface.force_scale = std::max(interface.force_scale, peak_force(interface, bodies_));
    interface.rebound_impulse = release_impulse(interface, bodies_);
  }
  for (Observer* observer : observers_)
    observer->on_window({window, bodies_.responses(), reports_});
  ++end_.windows;
  if (std::ranges::any_of(reports_, &InterfaceReport::closed)) ++end_.contact_windows;
  const bool whole = is_whole(window);
  advance_clock(window.end, whole);
  if (whole) events_here_ = 0;
  halvings_ = 0;
  for (std::size_t i = 0; i < coupling_.interfaces.size(); ++i) {
    Interface& interface = coupling_.interfaces[i];
    if (interface.closed && coupling_.rules[i].swap) interface.kinematic = 1 - interface.kinematic;
  }
}

// ---- clock --------------------------------------------------------------------------------------

TimeWindow Controller::next_window() const {
  TimeWindow window{end_.windows, time_,
                    anchor_ + static_cast<double>(since_ + 1) * scene_.time.window};
  // A remainder too short to be a window of its own belongs to the last one.
  if (window.end > scene_.time.end - clock_tolerance * scene_.time.window)
    window.end = scene_.time.end;
  return window;
}

void Controller::advance_clock(double end, bool whole) {
  time_ = end;
  if (whole) {
    ++since_;
  } else {
    anchor_ = end;
    since_ = 0;
  }
}

bool Controller::is_whole(const TimeWindow& window) const {
  return std::abs(window.length() - scene_.time.window) < clock_tolerance * scene_.time.window;
}

double Controller::shortest_step() const {
  double shortest = scene_.time.window;
  for (int b = 0; b < bodies_.count(); ++b) {
    if (bodies_.describe(b).step > 0.0) shortest = std::min(shortest, bodies_.describe(b).step);
  }
  return shortest;
}

// ---- contact ------------------------------------------------------------------------------------

void Controller::apply_criteria_at_start(const TimeWindow& window) {
  for (std::size_t i = 0; i < coupling_.interfaces.size(); ++i) {
    if (!coupling_.rules[i].published) continue;
    Interface& interface = coupling_.interfaces[i];
    const Waveform& t0 = trace_of(bodies_, interface.sides[0]);
    const Waveform& t1 = trace_of(bodies_, interface.sides[1]);
    if (!interface.closed) {
      if (interface.gap(t0.u.back(), t1.u.back()) < 0.0) {
        close(static_cast<int>(i), window.begin, std::abs(t0.v.back() - t1.v.back()));
      }
      continue;
    }
    // Persistence: a closed interface stays closed while the force handed over compresses.
    const int side = coupling_.rules[i].swap ? 1 - interface.kinematic : interface.kinematic;
    const Waveform& trace = side == 0 ? t0 : t1;
    if (-interface.normal_of(side) * trace.f.back() > 0.0) continue;
    apply({static_cast<int>(i), false, window.begin, window.begin, 0.0});
  }
}

std::vector<Controller::Event> Controller::first_events(const TimeWindow& window) const {
  std::vector<Event> events;
  for (std::size_t i = 0; i < coupling_.interfaces.size(); ++i) {
    if (!coupling_.rules[i].located()) continue;
    const Interface& interface = coupling_.interfaces[i];
    if (!interface.closed) {
      if (const std::optional<Closing> c = overlap_criterion(interface, bodies_)) {
        events.push_back({static_cast<int>(i), true, c->time, c->time, c->speed});
      }
      continue;
    }
    const double scale = std::max(interface.force_scale, peak_force(interface, bodies_));
    if (const std::optional<Opening> o =
            compression_criterion(interface, bodies_, force_floor * scale)) {
      events.push_back({static_cast<int>(i), false, o->state, o->crossing, 0.0});
    }
  }
  std::sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
    return a.state != b.state ? a.state < b.state : a.interface < b.interface;
  });
  const double together = event_tolerance * shortest_step();
  while (!events.empty() && events.back().state > events.front().state + together)
    events.pop_back();
  if (!events.empty() && events.front().closes && window.end - events.front().state < together) {
    events.front().state = window.end;
  }
  return events;
}

void Controller::close(int index, double time, double speed) {
  Interface& interface = coupling_.interfaces[static_cast<std::size_t>(index)];
  interface.closed = true;
  interface.closing_speed = speed;
  interface.force_scale = 0.0;
  Coupling::Rule& rule = coupling_.rules[static_cast<std::size_t>(index)];
  if (rule.projection) interface.release_impulse = closing_impulse(interface, bodies_);
  if (!rule.role_fixed) {
    interface.kinematic = scene_.schwarz.parallel
                              ? coarser_side(interface, bodies_)
                              : kinematic_side(interface, bodies_, scene_.time.window);
    rule.role_fixed = true;  // roles do not change during a run
  }
  emit(RunEvent::Kind::contact_closed, time, interface.name,
       fmt::format("contact closes at {:.6g} m/s; kinematic side: {}", speed,
                   bodies_.describe(interface.kinematic_side().body).name),
       {{"closing_speed", speed}});
}

void Controller::apply(const Event& event) {
  if (event.closes) return close(event.interface, event.located, event.speed);
  Interface& interface = coupling_.interfaces[static_cast<std::size_t>(event.interface)];
  interface.closed = false;
  interface.opened_at = event.state;
  interface.release_impulse = interface.rebound_impulse;
  interface.rebound_impulse = 0.0;
  emit(RunEvent::Kind::contact_opened, event.located, interface.name, "contact opens",
       {{"release_impulse", interface.release_impulse}});
}

void Controller::prepare(const TimeWindow& window, int records, Sampling sampling) {
  bodies_.prepare(window, records, sampling);
  for (const Interface& interface : coupling_.interfaces) {
    if (interface.release_impulse == 0.0) continue;
    for (int s : {0, 1}) {
      const Side& side = interface.sides[static_cast<std::size_t>(s)];
      bodies_.request(side.body).boundary[static_cast<std::size_t>(side.port)].impulse = {
          -interface.normal_of(s) * interface.release_impulse};
    }
  }
}

// ---- what others are told -----------------------------------------------------------------------

void Controller::fill_reports(const Attempt* attempt) {
  for (std::size_t i = 0; i < reports_.size(); ++i) {
    reports_[i] = {coupling_.interfaces[i].closed, coupling_.interfaces[i].kinematic};
  }
  if (attempt == nullptr) return;
  watch_internal();
  for (std::size_t k = 0; k < partition_.islands.size(); ++k) {
    for (int j : partition_.islands[k].joints) {
      reports_[static_cast<std::size_t>(j)].iterations = attempt->reports[k].iterations;
      reports_[static_cast<std::size_t>(j)].residual = attempt->reports[k].residual.largest();
    }
  }
}

void Controller::emit(RunEvent::Kind kind, double time, const std::string& subject,
                      const std::string& text, std::map<std::string, double> values) {
  const RunEvent event{kind, time, subject, text, std::move(values)};
  for (Observer* observer : observers_) observer->on_event(event);
}

void Controller::fail(double time, const std::string& text) {
  end_.status = "failed";
  emit(RunEvent::Kind::failure, time, "", text);
}

std::uint64_t Controller::state_hash() {
  std::uint64_t hash = 0;
  for (int b = 0; b < bodies_.count(); ++b) hash = hash_combine(hash, bodies_[b].state_hash());
  for (Interface& interface : coupling_.interfaces)
    hash = hash_combine(hash, hash_state(interface));
  return hash;
}

RunEnd Controller::finish(double wall_seconds) {
  end_.time = time_;
  end_.wall_seconds = wall_seconds;
  end_.exchanges = bodies_.exchanges();
  end_.compute_seconds = bodies_.compute_seconds();
  end_.overhead_median_seconds = bodies_.overhead_median();
  end_.state_hash = state_hash();
  for (Observer* observer : observers_) observer->on_end(end_);
  return end_;
}

}  // namespace abut
