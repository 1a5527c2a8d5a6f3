#include "coordinator/contact_events.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "coordinator/coupling/closing_speed.hpp"
#include "coordinator/coupling/nearness.hpp"
#include "coordinator/coupling/tie.hpp"
#include "coordinator/coupling/transmission.hpp"

namespace abut {

namespace {

constexpr double force_floor = 1.0e-9;  // of the largest contact force: less is no compression
// Of the fastest first touch: what meets more slowly only grazes, until it presses.
constexpr double grazing_share = 1.0e-2;
// Of the largest contact force of the run: what grazes and presses less only touches. Forerunners
// of a front reach a few per cent.
constexpr double pressing_share = 0.05;
// Of the fastest first touch: slower ones are no motion. Numerical forerunners begin at 1e-300.
constexpr double still_share = 1.0e-12;
// Of the largest energy of the run: what an event must move for a window to end there.
constexpr double notable_share = 1.0e-6;
// The same: what is owed for it to be paid after an event. Between events only what is notable is
// paid: to pay what the iteration leaves open would disturb more than it mends.
constexpr double payable_share = 1.0e-13;
// Ways that surfaces can come in a window: those nearer than this may meet in it and are iterated,
// those farther than that are free again.
constexpr double near_ways = 1.5, far_ways = 4.0;

bool has_shared_node(const Joint& joint, const Bodies& bodies) {
  return std::ranges::all_of(joint.sides, [&bodies](const Side& side) {
    return std::isinf(bodies.describe(side.body).mass) || bodies.port(side).tied;
  });
}

}  // namespace

void ContactEvents::state(Archive& archive) {
  archive.field("fastest_touch", fastest_touch_);
  archive.field("force_reference", force_reference_);
}

double ContactEvents::still() const { return still_share * fastest_touch_; }

void ContactEvents::start() {
  roles_.start(joints_);
  for (Joint& joint : joints_) {
    if (!joint.tied()) continue;
    joint.press();
    if (joint.how->tie() == nullptr && has_shared_node(joint, bodies_)) open(joint);
  }
}

/// A shared node has one velocity. Where it is kicked, it has that half a step before the begin
/// too: both ends know nothing of each other's force there, and their energies do not hold it
/// [M.123].
void ContactEvents::open(Joint& joint) {
  const double closing = closing_impulse(joint, bodies_), kick = opening_kick(joint, bodies_);
  for (const Side& side : joint.sides) bodies_.strike_energy(side, closing, kick);
  joint.impulse = closing + kick;
}

void ContactEvents::join() {
  for (Joint& joint : joints_) {
    const Tie* tie = joint.how == nullptr ? nullptr : joint.how->tie();
    if (tie != nullptr) joint.jump = tie->jump(joint, bodies_);
  }
}

/// Surfaces that may meet in the window are iterated, also where they do not: their bodies find
/// out. They are free again when they would need several windows to meet.
void ContactEvents::approach(Joint& joint, const TimeWindow& window) {
  if (joint.pressing()) return;
  measure_approach(joint, bodies_);
  const auto [apart, bound] = joint.approach;
  const double way = bound * window.length();
  joint.touch_speed = bound;
  if (!joint.closed() && apart <= near_ways * way) return engage(joint, bound, window.begin);
  if (joint.closed() && apart > far_ways * way) joint.disengage();
}

void ContactEvents::begin(const TimeWindow& window) {
  for (Joint& joint : joints_) {
    if (joint.surfaces) approach(joint, window);
    if (joint.decision != Decision::window_begin) continue;
    const Waveform& t0 = trace_of(bodies_, joint.sides[0]);
    const Waveform& t1 = trace_of(bodies_, joint.sides[1]);
    if (!joint.closed()) {
      if (joint.gap(t0.u.back(), t1.u.back()) >= 0.0) continue;
      const double speed = std::abs(t0.v.back() - t1.v.back());
      engage(joint, speed, window.begin);
      joint.press();
      if (joint.projection) joint.impulse = std::max(0.0, closing_impulse(joint, bodies_));
      narrator_.closed(joint, window.begin, speed);
      continue;
    }
    // Persistence: a closed joint stays closed while the force handed over compresses.
    const int side = joint.roles_swap ? 1 - joint.kinematic : joint.kinematic;
    const Waveform& trace = side == 0 ? t0 : t1;
    if (-joint.normal_of(side) * trace.f.back() > 0.0) continue;
    joint.disengage();
    narrator_.opened(joint, window.begin);
  }
}

// ---- in a window that was tried -----------------------------------------------------------------

std::optional<double> ContactEvents::engage_touching(const TimeWindow& window) {
  std::optional<double> first;
  const double negligible = still() * bodies_.shortest_step();
  for (Joint& joint : joints_) {
    if (!joint.unilateral() || joint.closed()) continue;
    if (joint.surfaces) {
      if (kept_apart(joint, bodies_, window.length())) continue;
      engage(joint, joint.approach.speed, window.begin);
      first = std::min(first.value_or(window.end), window.end);  // again, as a whole
      continue;
    }
    const std::optional<Touch> touch = first_overlap(joint, bodies_, negligible);
    if (!touch) continue;
    engage(joint, touch->speed, window.begin);
    first = std::min(first.value_or(touch->state), touch->state);
  }
  return first;
}

void ContactEvents::engage(Joint& joint, double speed, double time) {
  fastest_touch_ = std::max(fastest_touch_, speed);
  if (!joint.met) introduce(joint, bodies_);
  joint.engage(std::max(speed, still()));
  if (!roles_.choose(joint) || !joint.unilateral()) return;
  const double limit = stable_step_in_contact(joint, bodies_, window_);
  if (bodies_.describe(joint.neumann_side().body).step > limit)
    narrator_.lowered_step(joint, time, limit);
}

/// [N] of the window in history_: what the iteration leaves open is no force.
double ContactEvents::least_force(const Joint& joint) const {
  return std::max(force_floor, tolerance_) * std::max(joint.force_scale, history_.peak());
}

std::optional<double> ContactEvents::first_event(const TimeWindow& window, double energy) {
  std::optional<double> first;
  const double notable = notable_share * energy;
  for (Joint& joint : joints_) {
    if (!joint.deciding() || joint.surfaces) continue;  // these need no cut
    history_.read(joint, bodies_);
    const double floor = least_force(joint);
    for (std::size_t k = 1; k < history_.size(); ++k) {
      const ContactLevel& before = history_[k - 1];
      const bool gone = before.force > floor && history_[k].force <= floor;
      if (history_.kicks() ? !gone : std::abs(history_.energy(k)) <= notable) continue;
      const double at = history_.kicks() ? before.time : history_[k].time;
      const double end = at > window.begin ? common_end(window, at) : at;
      first = std::min(first.value_or(end), end);
      break;
    }
  }
  return first;
}

double ContactEvents::common_end(const TimeWindow& window, double time) const {
  constexpr double rounding = 1.0e-6;  // of a substep
  const double coarsest = bodies_.longest_step();
  const double last = std::round(window.length() / coarsest);
  for (double k = std::ceil((time - window.begin) / coarsest - rounding); k < last; k += 1.0) {
    bool common = true;
    for (int b = 0; b < bodies_.count() && common; ++b) {
      const double step = bodies_.describe(b).step;
      if (step <= 0.0) continue;
      const double count = k * coarsest / step;
      common = std::abs(count - std::round(count)) <= rounding;
    }
    if (common) return window.begin + k * coarsest;
  }
  return window.end;
}

bool ContactEvents::release_kicks(const TimeWindow& window) {
  bool released = false;
  for (Joint& joint : joints_) {
    if (!joint.deciding() || joint.surfaces) continue;
    history_.read(joint, bodies_);
    if (!history_.kicks() || history_.size() < 2) continue;
    const double floor = least_force(joint);
    if (history_[0].force <= floor || history_[1].force > floor) continue;
    joint.impulse = std::exchange(joint.rebound_impulse, 0.0);
    joint.opened_at = window.begin;
    if (joint.pressing()) {
      joint.release();
      narrator_.opened(joint, history_.release(1));
    }
    released = true;
  }
  return released;
}

std::optional<double> ContactEvents::earlier_end(const TimeWindow& window) const {
  const bool unilateral =
      std::ranges::any_of(joints_, [](const Joint& j) { return j.closed() && !j.tied(); });
  const bool kinks = std::ranges::any_of(
      joints_, [](const Joint& joint) { return joint.closed() && joint.how->projects(); });
  if (!unilateral || !kinks) return std::nullopt;
  const double half = common_end(window, window.begin + 0.5 * window.length());
  return half < window.end ? std::optional(half) : std::nullopt;
}

// ---- in a window that was accepted --------------------------------------------------------------

void ContactEvents::settle(const TimeWindow& window, double energy) {
  for (Joint& joint : joints_) {
    joint.impulse = 0.0;
    if (!joint.closed()) continue;
    if (joint.surfaces) {
      settle_surfaces(joint);
      continue;
    }
    if (const Tie* tie = joint.how->tie()) {
      joint.closing_speed = std::max(joint.closing_speed, tie->speed());
      joint.force_scale = std::max(joint.force_scale, tie->row_force());
      continue;
    }
    if (!joint.unilateral()) {
      joint.force_scale = std::max(joint.force_scale, peak_force(joint, bodies_));
      continue;
    }
    history_.read(joint, bodies_);
    joint.force_scale = std::max(joint.force_scale, history_.peak());
    force_reference_ = std::max(force_reference_, history_.peak());
    joint.debt -= contact_work(joint, bodies_);
    pay(joint, energy);
    narrate(joint);
    disengage(joint, window);
  }
}

/// Tells of pushes that begin and end: substeps decide about every point for themselves.
void ContactEvents::settle_surfaces(Joint& joint) {
  const Waveform& force = bodies_.reaction(joint.kinematic_side());
  const int dim = bodies_.port(joint.sides[0]).geometry.dim;
  joint.force_scale = std::max(joint.force_scale, peak_force(joint, bodies_));
  for (std::size_t i = 1; i < force.size(); ++i) {
    const bool presses = resultant(force, i, dim) > force_floor * joint.force_scale;
    if (presses && !joint.pressing()) {
      joint.press();
      narrator_.closed(joint, force.time[i], closing_speed_before(joint, bodies_, i));
    } else if (!presses && joint.pressing()) {
      joint.release();
      narrator_.opened(joint, force.time[i - 1]);
    }
  }
}

void ContactEvents::pay(Joint& joint, double energy) {
  joint.rebound_impulse = release_impulse(joint, bodies_);
  const std::size_t last = history_.size() - 1;
  const bool active = history_[last].force > 0.0 || (last > 0 && history_[last - 1].force > 0.0);
  if (history_.kicks() || !active) return;  // bodies that are apart give each other nothing
  bool changed = false;
  for (std::size_t k = 1; k <= last && !changed; ++k)
    changed = (history_[k - 1].force > 0.0) != (history_[k].force > 0.0);
  const double least = (changed ? payable_share : notable_share) * energy;
  if (std::abs(joint.debt) <= least) return;
  joint.impulse = paying_impulse(joint, bodies_);
  for (const Side& side : joint.sides) bodies_.strike_record(side, joint.impulse);
}

/// Tells of the pushes that begin and end in the window.
void ContactEvents::narrate(Joint& joint) {
  const double floor = std::max(least_force(joint), history_.rounding());
  const double bound = std::max(floor, pressing_share * force_reference_);
  for (std::size_t k = 1; k < history_.size(); ++k) {
    const ContactLevel& before = history_[k - 1];
    const ContactLevel& now = history_[k];
    if (now.force > floor && before.force <= floor) {
      const Touch touch = history_.touch(k);
      joint.touched_at = touch.time;
      joint.touch_speed = touch.speed;
      fastest_touch_ = std::max(fastest_touch_, touch.speed);
    }
    const bool fast = joint.touch_speed > grazing_share * fastest_touch_;
    if (!joint.pressing() && now.force > floor && (fast || now.force > bound)) {
      joint.press();
      const double begin = fast ? joint.touched_at : history_.crossing(k, bound);
      joint.closing_speed = std::max(joint.touch_speed, still());
      narrator_.closed(joint, begin, joint.touch_speed);
    } else if (joint.pressing() && now.force <= floor) {
      joint.release();
      narrator_.opened(joint, history_.release(k));
    }
  }
}

/// Sides that have parted are free again.
void ContactEvents::disengage(Joint& joint, const TimeWindow& window) const {
  const double gap = history_[history_.size() - 1].gap;
  const bool apart = gap > grazing_share * fastest_touch_ * window.length();
  if (!apart || peak_force(joint, bodies_) > 0.0 || joint.pressing()) return;
  joint.disengage();
}

void ContactEvents::watch_inside(std::span<InterfaceReport> reports) {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (joints_[j].decision != Decision::inside) continue;
    const InternalContact seen = watch_internal_contact(joints_[j], bodies_);
    reports[joints_[j].interface].closed = seen.pressed;
    for (const InternalContact::Change& change : seen.changes) narrator_.inside(joints_[j], change);
  }
}

void ContactEvents::swap_roles() {
  for (Joint& joint : joints_) {
    if (joint.closed() && joint.roles_swap) joint.kinematic = 1 - joint.kinematic;
  }
}

}  // namespace abut
