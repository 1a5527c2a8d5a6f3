#include "coordinator/controller.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "base/archive.hpp"
#include "base/count.hpp"
#include "base/denormals.hpp"
#include "base/index.hpp"
#include "base/unit_words.hpp"
#include "coordinator/coupling/exchange.hpp"
#include "coordinator/coupling/horizon.hpp"
#include "coordinator/coupling/velocity_start.hpp"
#include "coordinator/coupling/work_of_contact.hpp"
#include "coordinator/energy_account.hpp"
#include "coordinator/flight_work.hpp"
#include "coordinator/record/validity_notes.hpp"
#include "coordinator/settled_end.hpp"
#include "coordinator/touching_pairs.hpp"

namespace abut {

namespace {

std::vector<const Description*> descriptions_of(const Bodies& bodies) {
  std::vector<const Description*> descriptions;
  for (int b = 0; b < bodies.count(); ++b) descriptions.push_back(&bodies.describe(b));
  return descriptions;
}

}  // namespace

Controller::Controller(const Scene& scene, std::vector<Subdomain*> bodies,
                       std::vector<Observer*> observers, const std::atomic<bool>* interrupted)
    : scene_(scene),
      bodies_(std::move(bodies), scene.time.window),
      interrupted_(interrupted),
      narrator_(bodies_, std::move(observers), declared_units(scene.units)),
      joints_(make_joints(scene, bodies_)),
      broad_phase_(make_broad_phase(scene, joints_, bodies_)),
      schwarz_(make_schwarz(scene.schwarz, alternating_joints(scene))),
      clock_(scene.time.begin, scene.time.end, scene.time.window),
      roles_(bodies_, scene.time.window, scene.schwarz.parallel),
      events_(joints_, bodies_, roles_, narrator_, scene.schwarz.tolerance, scene.time.window),
      guard_(
          make_energy_guard(scene.schwarz.energy_guard, joints_, !broad_phase_.empty(), bodies_)),
      passive_(touching_pairs(scene, joints_, bodies_), passive_ties(scene, joints_, bodies_),
               bodies_, scene.time.window),
      crossing_(touching_pairs(scene, joints_, bodies_), bodies_),
      folds_(touching_pairs(scene, joints_, bodies_), bodies_),
      reports_(joints_.size() + (broad_phase_.empty() ? 0 : 1)) {
  end_.status = "completed";
  settles_ = std::ranges::any_of(descriptions_of(bodies_),
                                 [](const Description* body) { return body->stabilised; });
  if (scene.time.until) event_.emplace(scene);
  flight_.longest = flight_.limit =
      windows_at_once(scene.time.window, scene.output.records_per_window, descriptions_of(bodies_));
}

// ---- the loop -----------------------------------------------------------------------------------

RunEnd Controller::run() {
  const FlushedDenormals flushed;
  const auto began = std::chrono::steady_clock::now();
  auto wall = [began] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  };
  try {
    if (!resumed_) start();
    while (running()) {
      if (event_ && event_->is_over(joints_, clock_.next(), bodies_)) {
        stop();
        break;
      }
      pause();
      join_near();
      if (event_) event_->remember(bodies_);
      if (passive_.active())
        step_passively();
      else if (!fly_free())
        step_window();
    }
    if (event_ && !event_->stopped() && end_.status == "completed" && clock_.at_end())
      narrator_.not_come(event_->words(), clock_.time());
    if (end_.status == "completed") pause();
    if (goes_on()) end_.status = "interrupted";
    return finish(wall());  // asks the bodies for their states: they may be lost there as well
  } catch (const std::exception& error) {  // RunError, an InputError of a body, lack of memory
    const bool interrupted = interrupted_ != nullptr && interrupted_->load();
    give_up(error, interrupted, wall());
    if (!interrupted) throw;
    return end_;
  }
}

void Controller::pause() {
  if (between_windows)
    between_windows({clock_.time(), clock_.windows(), clock_.at_end(), goes_on() && !running()});
}

bool Controller::running() const {
  return goes_on() && !(interrupted_ != nullptr && interrupted_->load());
}

/// Whether anything but an interruption ends it: all that a run does between two looks at that is
/// done whole, so that it resumes as if it had gone on.
bool Controller::goes_on() const { return end_.status == "completed" && !clock_.at_end(); }

/// What bodies are told before the first window: whom they may meet, and what replies are to hold.
void Controller::introduce() {
  for (Joint& joint : joints_)
    if (joint.exchange != nullptr) joint.exchange->introduce(joint, bodies_);
  bodies_.want({.a = wants_accelerations(), .points = {}});
}

/// The published form exchanges them.
bool Controller::wants_accelerations() const {
  return std::ranges::any_of(
      scene_.interfaces, [](const auto& entry) { return is_published(entry.second.transmission); });
}

void Controller::start() {
  const SpanScope span(bodies_.spans(), "start");
  if (!staged_) {
    introduce();
    narrator_.start(scene_.time.begin, scene_.time.end, joints_, !broad_phase_.empty());
  }
  for (const Joint& joint : joints_) {
    if (energy_account_of(joint) != EnergyAccount::doubled) continue;
    narrator_.warning(clock_.time(), joint.name,
                      "where bodies overlap and exchange motions alone, each has all of the "
                      "material: energy.total and momentum.total count it twice there");
  }
  want_opening_accelerations(true);
  const TimeWindow instant{0, clock_.time(), clock_.time()};
  std::vector<Response> earlier;  // what pressed at the end of the stage before
  if (staged_) earlier.assign(bodies_.responses().begin(), bodies_.responses().end());
  bodies_.save_all();
  prepare(instant, 1, Sampling::substeps);
  if (std::optional<Failed> failed = bodies_.advance_all())
    return fail(failed->time, failed->detail);
  if (staged_) bodies_.keep_reactions(earlier);
  events_.start();
  for (const auto& [joint, contact, part] : known_exchanges(joints_).obstacles)
    narrator_.found(*joint, clock_.time());
  for (const Joint& joint : joints_) narrator_.pressed_in(joint, clock_.time());
  watch_energy(guard_.look(bodies_.responses(), bodies_.struck()));
  tell_swaps();
  if (!staged_) {  // else this instant was told as an end
    fill_reports(true);
    narrator_.window({instant, bodies_.responses(), reports_, 0, {}});
    events_.engage_sprung(clock_.time());
    if (broad_phase_.has_open_surfaces()) look_for_overlaps();  // which boxes tell nothing of
  }
  want_opening_accelerations(wants_accelerations());
  unite_start();
}

/// Of ends of bars that share a node.
void Controller::want_opening_accelerations(bool wanted) {
  const std::vector<bool> share = share_nodes(joints_);
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (!share[j]) continue;
    for (const Side& side : joints_[j].sides) bodies_.request(side.body).want[side.port].a = wanted;
  }
}

/// Records have told of the start as the scene gives it.
void Controller::unite_start() {
  std::vector<UnlikeStart> unlike;
  start_lost_ = kinetic_energies();
  if (std::optional<Failed> failed = unite_velocities(joints_, clock_.time(), bodies_, unlike))
    return fail(failed->time, failed->detail);
  const std::vector<double> after = kinetic_energies();
  for (std::size_t b = 0; b < after.size(); ++b) start_lost_[b] -= after[b];
  tell_lost_at_start();
  for (const UnlikeStart& start : unlike)
    narrator_.warning(clock_.time(), start.joint->name,
                      fmt::format("velocities of its sides differ by {:.3g} m/s at the start, and "
                                  "body '{}' takes no impulses that would make them one: the sides "
                                  "go on swinging against each other; give both the same",
                                  start.speed, start.body));
}

bool Controller::fly_free() {
  const bool waits = std::ranges::any_of(
      joints_, [](const Joint& joint) { return joint.closed() || joint.contact.impulse != 0.0; });
  if (waits || std::exchange(flight_.grounded, false)) return false;
  const int windows = windows_to_fly();
  if (windows < 1) return false;
  const TimeWindow flight = clock_.flight(windows);
  bodies_.save_all();
  SpanScope span(bodies_.spans(), "flight", clock_.windows());
  span.covers(flight.begin, flight.end);
  prepare(flight, windows * scene_.output.records_per_window, Sampling::records);
  std::optional<Failed> failed = bodies_.advance_all();
  if (!failed) failed = made_by_themselves(flight);
  if (failed) {
    if (windows == 1) {
      bodies_.restore_all();
      if (!go_passively(flight.begin, failed->detail)) fail(failed->time, failed->detail);
    } else {  // again in shorter flights, so that what was before the failure is told
      bodies_.restore_all();
      flight_.limit = windows / 2;
    }
    return true;
  }
  if (!broad_phase_.empty()) join(broad_phase_.crossed(bodies_));
  if (!stayed_apart(joints_, bodies_, flight.length()) || !folded().empty()) {
    bodies_.restore_all();
    flight_.grounded = true;
    flight_.limit = std::max(1, windows / 4);  // the bound was wrong: trust it less for a while
    return false;
  }
  fill_reports(true);
  const std::int64_t before = clock_.windows();
  clock_.accept_flight(flight, windows);
  narrator_.window({flight, bodies_.responses(), reports_, clock_.windows(), {}});
  watch_passing(before);
  watch_energy(guard_.look(bodies_.responses()));
  flight_.limit = std::min(flight_.longest, 2 * flight_.limit);
  return true;
}

TimeWindow Controller::next_window() {
  TimeWindow next = clock_.next();
  if (settles_) {
    next = before_settled_end(next, scene_.time.end);
    if (is_after_cut(next, scene_.time.end) && borne_of_allowed(bodies_) > 1.0)
      next.end = settled_further(next, scene_.time.end).value_or(next.end);
  }
  return events_.even(next);
}

void Controller::step_window() {
  TimeWindow window = next_window();
  if (ends_before(window)) return;
  if (must_go_passively(window)) return step_passively();
  SpanScope span(bodies_.spans(), "window", clock_.windows());
  span.covers(window.begin, window.end);
  events_.begin(window);
  if (ends_before(window)) return;
  bodies_.save_all();
  const bool ends = settles_ && window.end >= scene_.time.end;
  const double borne_before = ends ? borne_of_allowed(bodies_) : 0.0;
  while (goes_on()) {
    try_window(window);
    if (ends_in_window()) return;
    Judgement judgement = judge(window);
    if (judgement.verdict == Judgement::Verdict::accept && borne_before > 0.0)
      judgement = judge_springs(window, borne_before);
    if (judgement.verdict == Judgement::Verdict::accept) {
      span.covers(window.begin, window.end);
      return accept(window);
    }
    if (judgement.verdict == Judgement::Verdict::fail) {
      bodies_.restore_all();
      if (judgement.final || !go_passively(window.begin, judgement.reason))
        fail(window.begin, judgement.reason);
      return;
    }
    if (judgement.verdict == Judgement::Verdict::cut) window.end = judgement.end;
    window = events_.even(window);
    bodies_.restore_all();
    if (ends_before(window)) return;
    if (must_go_passively(window)) return step_passively();  // they came faster than was foreseen
  }
}

void Controller::advance(const TimeWindow& window) {
  attempt_.failed.reset();
  attempt_.reports.clear();
  prepare(window, records_in(window), Sampling::substeps);
  if (partition_.update(joints_, bodies_.count())) schwarz_.keep(partition_.islands());
  for (const Island& island : partition_.islands()) {
    std::variant<SchwarzReport, Failed> result = schwarz_.solve(window, island, joints_, bodies_);
    if (Failed* failed = std::get_if<Failed>(&result); failed != nullptr) {
      attempt_.failed = std::move(*failed);
      return;
    }
    attempt_.reports.push_back(std::get<SchwarzReport>(result));
  }
  attempt_.failed = bodies_.advance(partition_.free());
}

Controller::Judgement Controller::judge(const TimeWindow& window) {
  using Verdict = Judgement::Verdict;
  if (attempt_.failed || !attempt_.converged()) {
    const Judgement trouble = judge_trouble(window);
    if (trouble.verdict != Verdict::accept) return trouble;
  }
  if (!broad_phase_.empty()) join(broad_phase_.crossed(bodies_));
  if (const std::optional<double> touch = events_.engage_touching(window))
    return {Verdict::cut, events_.common_end(window, *touch), {}};
  const std::optional<double> event = events_.first_event(window, guard_.most());
  if (!event || *event >= window.end) return judge_ways(window);
  if (*event > window.begin) return {Verdict::cut, *event, {}};
  if (events_.release_kicks(window)) return {Verdict::again, window.end, {}};
  return judge_ways(window);
}

/// Surfaces may have passed through each other, where bodies could go another way.
Controller::Judgement Controller::judge_ways(const TimeWindow& window) {
  if (std::string meets = folded(); !meets.empty())
    return {Judgement::Verdict::fail, window.end, std::move(meets)};
  const bool near = std::ranges::any_of(joints_, [](const Joint& j) { return j.closed(); });
  if (!may_go_passively()) return {};
  if (!near) {
    if (std::optional<Failed> made = made_by_themselves(window))
      return {Judgement::Verdict::fail, window.end, std::move(made->detail)};
    return {};
  }
  const Judgement gains = {Judgement::Verdict::fail, window.end, "contact would make energy"};
  if (passive_.on_a_line()) {
    if (guard_.ends(bodies_.responses(), events_.payments(guard_.most()))) return gains;
    repay();
    return {};
  }
  if (guard_.refuses(bodies_.responses(), bodies_.struck())) return gains;
  if (guard_.loses(bodies_.responses(), lost_to_contact(joints_, bodies_), bodies_.struck()))
    return {Judgement::Verdict::fail, window.end, "contact would take energy"};
  if (std::string crossed = crossing_.look(); !crossed.empty()) {
    if (passive_.statics() && halvings_ < most_halvings()) return halved(window, crossed);
    return {Judgement::Verdict::fail, window.end, std::move(crossed)};
  }
  return repay() ? Judgement() : gains;
}

Controller::Judgement Controller::judge_trouble(const TimeWindow& window) {
  using Verdict = Judgement::Verdict;
  if (!attempt_.failed) {
    if (const std::optional<double> end = events_.earlier_end(window))
      return {Verdict::cut, *end, {}};
  }
  for (const SchwarzReport& report : attempt_.reports)  // no shorter window changes it
    if (!report.contradiction.empty())
      return {Verdict::fail, window.end, report.contradiction, true};
  const std::string text = attempt_.trouble(scene_.schwarz.tolerance);
  const OnNonconvergence policy = scene_.schwarz.on_nonconvergence;
  if (policy == OnNonconvergence::accept && !attempt_.failed) {
    narrator_.warning(window.begin, "", text + "; accepted as the scene says");
    return {};
  }
  if (halvings_ < most_halvings()) return halved(window, text);
  if (nearly_converged()) return {};
  if (attempt_.failed) return {Verdict::fail, window.end, text};
  return {Verdict::fail, window.end, text + "; " + sweeps_remedy(descriptions_of(bodies_))};
}

Controller::Judgement Controller::halved(const TimeWindow& window, const std::string& why) {
  ++halvings_;
  narrator_.warning(window.begin, "", why + "; the window is halved");
  return {Judgement::Verdict::cut, window.begin + 0.5 * window.length(), {}};
}

void Controller::accept(const TimeWindow& window) {
  for (const Island& island : partition_.islands()) schwarz_.accept(island);
  note_friction();
  note_near(window);
  fill_reports(false);
  events_.settle(window, guard_.most());
  halvings_ = 0;
  ++waiting_.accurate;
  end_window(window, guard_.look(bodies_.responses(), bodies_.struck()));
}

/// Of a window that was stepped, in whatever way.
void Controller::end_window(const TimeWindow& window, EnergyGuard::Verdict energy) {
  const std::int64_t before = clock_.windows();
  clock_.accept(window);
  narrator_.window({window, bodies_.responses(), reports_, clock_.windows(), pairs_});
  watch_passing(before);
  if (std::ranges::any_of(reports_, &InterfaceReport::closed)) ++end_.contact_windows;
  if (event_) event_->see(reports_);
  watch_energy(energy);
}

// ---- of a window --------------------------------------------------------------------------------

/// As many as the horizon allows, and that do not pass the next windows whose fields are wanted.
int Controller::windows_to_fly() {
  const double whole = clock_.whole_windows(free_flight_horizon(joints_, bodies_));
  int most = flight_.limit;
  if (const int every = scene_.output.looked_at_every(); every > 0) {
    most = std::min(most, every - static_cast<int>(clock_.windows() % every));
  }
  most = count_within(std::min(whole, most_substeps * bodies_.shortest_step() / scene_.time.window),
                      0, most);
  return broad_phase_.free_windows(bodies_, scene_.time.window, most);
}

void Controller::prepare(const TimeWindow& window, int records, Sampling sampling) {
  bodies_.prepare(window, records, sampling);
  for (const Joint& joint : joints_) {
    if (joint.contact.impulse == 0.0) continue;
    for (int s : {0, 1})
      bodies_.boundary(joint.sides[s]).impulse = {-joint.normal_of(s) * joint.contact.impulse};
  }
}

/// A window that was cut keeps the distance of its records, about.
int Controller::records_in(const TimeWindow& window) const {
  const double share = std::min(1.0, window.length() / scene_.time.window);
  return std::max(1, static_cast<int>(std::lround(scene_.output.records_per_window * share)));
}

/// What bodies tell of friction in an accurate window; passive ones are in the passive way's
/// ledger.
void Controller::note_friction() {
  for (Joint& joint : joints_)
    if (const double told = friction_told(joint, bodies_); told > 0.0)
      joint.contact.rubbed[index(joint.role.kinematic)] = told;
}

double Controller::dissipated(const Joint& joint) const {
  return joint.contact.rubbed[0] + joint.contact.rubbed[1] + passive_.rubbed(joint);
}

PairReport Controller::pair_report(const Joint& joint) const {
  const auto& [one, two] = joint.sides;
  return {joint.interface,      {one.body, two.body},
          {one.port, two.port}, {one.partner, two.partner},
          joint.role.kinematic, dissipated(joint)};
}

void Controller::fill_reports(bool flown) {
  std::ranges::fill(reports_, InterfaceReport{});
  pairs_.clear();
  for (const Joint& joint : joints_) {
    const Shown shown = joint.watch->show(joint, bodies_);
    InterfaceReport& report = reports_[joint.interface];
    report.closed = report.closed || shown.closed;
    report.kinematic = joint.role.kinematic;
    report.missed = std::max(report.missed, shown.missed);
    report.force = std::max(report.force, shown.force);
    report.dissipated += dissipated(joint);
  }
  if (flown) return;
  for (std::size_t k = 0; k < attempt_.reports.size(); ++k) {
    for (const int j : partition_.islands()[k].joints) {
      const Joint& joint = joints_[j];
      InterfaceReport& report = reports_[joint.interface];
      report.iterations = std::max(report.iterations, attempt_.reports[k].iterations);
      report.residual = std::max(report.residual, attempt_.reports[k].residual.largest());
      if (index(joint.interface) < scene_.interfaces.size()) continue;
      pairs_.push_back(pair_report(joint));
    }
  }
}

// ---- of the run ---------------------------------------------------------------------------------

/// Contact is passive, and so are supports: energy that appears says that steps or windows are
/// unstable here. Contact inside a body is that body's own affair.
void Controller::watch_energy(EnergyGuard::Verdict verdict) {
  const bool inside =
      std::ranges::any_of(joints_, [](const Joint& joint) { return joint.exchange == nullptr; });
  if (verdict == EnergyGuard::Verdict::fine || inside) return;
  if (verdict == EnergyGuard::Verdict::warn) {
    narrator_.energy(guard_, joints_, clock_.time());
  } else if (end_.status == "completed") {
    fail(clock_.time(), narrator_.words_of(guard_, joints_) +
                            fmt::format("; the bound of {:g} % is schwarz.energy_guard",
                                        100.0 * scene_.schwarz.energy_guard));
  }
}

/// After a window or a flight: nothing passes without a word. Bodies are asked where their fields
/// are written anyway.
void Controller::watch_passing(std::int64_t windows_before) {
  for (Joint& joint : joints_) joint.watch->see_passing(joint, bodies_);
  if (!scene_.output.field_output) return;
  const int every = scene_.output.field_output->every;
  if (clock_.windows() / every > windows_before / every) look_for_overlaps();
}

void Controller::fail(double time, const std::string& text) {
  end_.status = "failed";
  end_.reason = narrator_.in_units(text);
  narrator_.failure(time, text);
}

}  // namespace abut
