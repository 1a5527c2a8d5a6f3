#include "coordinator/controller.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "base/archive.hpp"
#include "base/count.hpp"
#include "base/denormals.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "coordinator/coupling/contact.hpp"
#include "coordinator/coupling/horizon.hpp"
#include "coordinator/flight_work.hpp"
#include "coordinator/record/validity_notes.hpp"

namespace abut {

namespace {

constexpr double clock_tolerance = 1.0e-9;  // of a window: the end is reached
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
      time_(scene.time.begin),
      energy_guard_(scene.schwarz.energy_guard, conserving_bodies()) {
  end_.status = "completed";
  reports_.resize(coupling_.interfaces.size());
  std::vector<const Description*> descriptions;
  for (int b = 0; b < bodies_.count(); ++b) descriptions.push_back(&bodies_.describe(b));
  longest_flight_ = flight_limit_ = windows_at_once(scene.time.window, descriptions);
}

RunEnd Controller::run() {
  const FlushedDenormals flushed;
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
  if (!interrupted) {
    end_.status = "failed";
    const std::string text = (error.where.empty() ? "" : error.where + ": ") + error.what_is_wrong;
    tell({RunEvent::Kind::failure, time_, blamed(text), text, {}, true});
  }
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
  for (std::size_t k = 0; k < coupling_.interfaces.size(); ++k) {
    const Interface& i = coupling_.interfaces[k];
    start.interfaces.push_back({i.name,
                                {i.sides[0].body, i.sides[1].body},
                                {i.sides[0].port, i.sides[1].port},
                                i.reference_gap,
                                coupling_.rules[k].tied});
  }
  for (Observer* observer : observers_) observer->on_start(start);
  const TimeWindow instant{0, time_, time_};
  bodies_.save_all();
  prepare(instant, 1, Sampling::substeps);
  if (std::optional<Failed> failed = bodies_.advance_all())
    return fail(failed->time, failed->detail);
  tie();
  watch_energy(time_, energy_guard_.look(bodies_.responses()));
  fill_reports(nullptr);
  for (Observer* observer : observers_)
    observer->on_window({instant, bodies_.responses(), reports_});
}

bool Controller::fly_free() {
  const bool waits = std::any_of(coupling_.interfaces.begin(), coupling_.interfaces.end(),
                                 [](const Interface& i) { return i.closed || i.impulse != 0.0; });
  if (waits || std::exchange(grounded_, false)) return false;
  const double window = scene_.time.window;
  const double horizon = free_flight_horizon(coupling_.interfaces, bodies_);
  const double left = scene_.time.end - time_;
  const double whole = std::floor(std::min(horizon, left) / window + clock_tolerance);
  const int windows = count_within(std::min(whole, most_substeps * shortest_step() / window), 0,
                                   std::min(flight_limit_, windows_to_fields()));
  if (windows < 1) return false;
  TimeWindow flight = next_window();
  flight.end = anchor_ + static_cast<double>(since_ + windows) * window;
  if (std::abs(flight.end - scene_.time.end) < clock_tolerance * window)
    flight.end = scene_.time.end;
  bodies_.save_all();
  prepare(flight, windows * scene_.output.records_per_window, Sampling::records);
  if (std::optional<Failed> failed = bodies_.advance_all()) {
    if (windows == 1) {
      fail(failed->time, failed->detail);
    } else {  // again in shorter flights, so that what was before the failure is told
      bodies_.restore_all();
      flight_limit_ = windows / 2;
    }
    return true;
  }
  if (!stayed_apart(coupling_.interfaces, bodies_)) {
    bodies_.restore_all();
    grounded_ = true;
    flight_limit_ = std::max(1, windows / 4);  // the bound was wrong: trust it less for a while
    return false;
  }
  fill_reports(nullptr);
  end_.windows += windows;
  for (Observer* observer : observers_)
    observer->on_window({flight, bodies_.responses(), reports_, end_.windows});
  since_ += windows;
  time_ = flight.end;
  watch_energy(time_, energy_guard_.look(bodies_.responses()));
  flight_limit_ = std::min(longest_flight_, 2 * flight_limit_);
  return true;
}

void Controller::step_window() {
  TimeWindow window = next_window();
  apply_criteria_at_start(window);
  bodies_.save_all();
  while (running()) {
    const Verdict verdict = judge(window);
    if (verdict == Verdict::stop) return;
    if (verdict == Verdict::accept) return accept(window, attempt_);
    bodies_.restore_all();
  }
}

/// Tries the window and says what becomes of it; it may end earlier the next time.
Controller::Verdict Controller::judge(TimeWindow& window) {
  const Attempt& attempt = advance(window);
  if (attempt.failed || !attempt.converged()) {
    if (!attempt.failed && shorten(window)) return Verdict::again;
    if (!handle_trouble(attempt, window)) return Verdict::stop;
    if (attempt.failed || scene_.schwarz.on_nonconvergence != "accept") return Verdict::again;
  }
  if (const std::optional<double> touch = engage_touching()) {
    window.end = common_end(window, *touch);
    return Verdict::again;
  }
  const std::optional<double> event = first_event(window);
  if (!event || *event >= window.end) return Verdict::accept;
  if (*event <= window.begin) return release_kicks(window) ? Verdict::again : Verdict::accept;
  window.end = *event;
  return Verdict::again;
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
  partition_.free.resize(index(bodies_.count()));
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
  prepare(window, records_in(window), Sampling::substeps);
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

/// A window that was cut keeps the distance of its records, about.
int Controller::records_in(const TimeWindow& window) const {
  const double share = std::min(1.0, window.length() / scene_.time.window);
  return std::max(1, static_cast<int>(std::lround(scene_.output.records_per_window * share)));
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
    interface.impulse = 0.0;
    if (!interface.closed || coupling_.rules[i].unilateral()) continue;
    interface.force_scale = std::max(interface.force_scale, peak_force(interface, bodies_));
  }
  ++end_.windows;
  settle(window);
  const EnergyGuard::Verdict energy = energy_guard_.look(bodies_.responses(), bodies_.struck());
  for (Observer* observer : observers_)
    observer->on_window({window, bodies_.responses(), reports_, end_.windows});
  if (std::ranges::any_of(reports_, &InterfaceReport::closed)) ++end_.contact_windows;
  advance_clock(window.end, is_whole(window));
  halvings_ = 0;
  watch_energy(window.end, energy);
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

int Controller::windows_to_fields() const {
  if (!scene_.output.field_output) return longest_flight_;
  const int every = scene_.output.field_output->every;
  return every - static_cast<int>(end_.windows % every);
}

double Controller::shortest_step() const {
  double shortest = scene_.time.window;
  for (int b = 0; b < bodies_.count(); ++b) {
    if (bodies_.describe(b).step > 0.0) shortest = std::min(shortest, bodies_.describe(b).step);
  }
  return shortest;
}

void Controller::prepare(const TimeWindow& window, int records, Sampling sampling) {
  bodies_.prepare(window, records, sampling);
  for (const Interface& interface : coupling_.interfaces) {
    if (interface.impulse == 0.0) continue;
    for (int s : {0, 1}) {
      const Side& side = interface.sides[index(s)];
      bodies_.request(side.body).boundary[index(side.port)].impulse = {-interface.normal_of(s) *
                                                                       interface.impulse};
    }
  }
}

// ---- what others are told -----------------------------------------------------------------------

void Controller::fill_reports(const Attempt* attempt) {
  for (std::size_t i = 0; i < reports_.size(); ++i) {
    const Interface& interface = coupling_.interfaces[i];
    const bool silent = coupling_.rules[i].unilateral() && interface.closed &&
                        peak_force(interface, bodies_) == 0.0;
    reports_[i] = {interface.closed && !silent, interface.kinematic};
  }
  if (attempt == nullptr) return;
  watch_internal();
  for (std::size_t k = 0; k < partition_.islands.size(); ++k) {
    for (int j : partition_.islands[k].joints) {
      reports_[index(j)].iterations = attempt->reports[k].iterations;
      reports_[index(j)].residual = attempt->reports[k].residual.largest();
    }
  }
}

/// Contact is passive, and so are supports: energy that appears says that steps or windows are
/// unstable here. Contact inside a body is that body's own affair.
void Controller::watch_energy(double time, EnergyGuard::Verdict verdict) {
  const bool internal = std::ranges::any_of(coupling_.rules, &Coupling::Rule::internal);
  if (verdict == EnergyGuard::Verdict::fine || internal) return;
  const double growth = energy_guard_.growth();
  const int body = energy_guard_.culprit();
  const std::string whose =
      body < 0 ? "" : fmt::format(" of body '{}'", bodies_.describe(body).name);
  const std::string text =
      growth < 0.0 ? fmt::format(
                         "energy{} has fallen by {:.2g} % of the most there was in motion, and "
                         "nothing in this scene takes any; give smaller steps",
                         whose, -100.0 * growth)
                   : fmt::format(
                         "energy{} has grown by {:.2g} % of the most there was in motion, and "
                         "contact makes none; give smaller steps, or contact_layer: massless",
                         whose, 100.0 * growth);
  if (verdict == EnergyGuard::Verdict::warn) {
    emit(RunEvent::Kind::warning, time, "", text, {{"growth", growth}});
  } else if (end_.status == "completed") {
    fail(time, text + fmt::format("; the bound of {:g} % is schwarz.energy_guard",
                                  100.0 * scene_.schwarz.energy_guard));
  }
}

/// Bodies whose every exchange of energy is told. The published form overwrites motion, which does
/// work that nobody knows.
std::vector<bool> Controller::conserving_bodies() const {
  std::vector<bool> conserves;
  for (int b = 0; b < bodies_.count(); ++b) conserves.push_back(bodies_.describe(b).conserves);
  for (std::size_t i = 0; i < coupling_.interfaces.size(); ++i) {
    if (!coupling_.rules[i].published && !coupling_.rules[i].internal) continue;
    for (const Side& side : coupling_.interfaces[i].sides) conserves[index(side.body)] = false;
  }
  return conserves;
}

void Controller::emit(RunEvent::Kind kind, double time, const std::string& subject,
                      const std::string& text, std::map<std::string, double> values) {
  tell({kind, time, subject, text, std::move(values)});
}

void Controller::tell(const RunEvent& event) {
  for (Observer* observer : observers_) observer->on_event(event);
}

std::string Controller::blamed(const std::string& text) const {
  for (int b = 0; b < bodies_.count(); ++b) {
    const std::string& name = bodies_.describe(b).name;
    if (text.find("body '" + name + "'") != std::string::npos) return name;
  }
  return "";
}

void Controller::fail(double time, const std::string& text) {
  end_.status = "failed";
  emit(RunEvent::Kind::failure, time, blamed(text), text);
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
  for (int b = 0; b < bodies_.count(); ++b) {
    end_.body_measures.push_back(bodies_[b].measure());
    for (const std::string& note : validity_notes(bodies_.describe(b), end_.body_measures.back()))
      emit(RunEvent::Kind::warning, time_, bodies_.describe(b).name, note);
  }
  for (Observer* observer : observers_) observer->on_end(end_);
  return end_;
}

}  // namespace abut
