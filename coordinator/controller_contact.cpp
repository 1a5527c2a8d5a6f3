#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/index.hpp"
#include "coordinator/controller.hpp"
#include "coordinator/coupling/contact.hpp"
#include "coordinator/coupling/roles.hpp"

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

bool has_shared_node(const Interface& interface, const Bodies& bodies) {
  return std::ranges::all_of(interface.sides, [&bodies](const Side& side) {
    const Description& body = bodies.describe(side.body);
    return std::isinf(body.mass) || body.ports[index(side.port)].tied;
  });
}

}  // namespace

void Controller::apply_criteria_at_start(const TimeWindow& window) {
  for (std::size_t i = 0; i < coupling_.interfaces.size(); ++i) {
    if (!coupling_.rules[i].published || coupling_.rules[i].tied) continue;
    Interface& interface = coupling_.interfaces[i];
    const Waveform& t0 = trace_of(bodies_, interface.sides[0]);
    const Waveform& t1 = trace_of(bodies_, interface.sides[1]);
    if (!interface.closed) {
      if (interface.gap(t0.u.back(), t1.u.back()) >= 0.0) continue;
      const double speed = std::abs(t0.v.back() - t1.v.back());
      engage(static_cast<int>(i), speed);
      if (coupling_.rules[i].projection)
        interface.impulse = std::max(0.0, closing_impulse(interface, bodies_));
      tell_closed(interface, window.begin, speed);
      continue;
    }
    // Persistence: a closed interface stays closed while the force handed over compresses.
    const int side = coupling_.rules[i].swap ? 1 - interface.kinematic : interface.kinematic;
    const Waveform& trace = side == 0 ? t0 : t1;
    if (-interface.normal_of(side) * trace.f.back() > 0.0) continue;
    interface.closed = false;
    tell_opened(interface, window.begin);
  }
}

/// Tied interfaces are closed before the first window and for the whole run.
void Controller::tie() {
  for (std::size_t i = 0; i < coupling_.interfaces.size(); ++i) {
    if (!coupling_.rules[i].tied) continue;
    Interface& interface = coupling_.interfaces[i];
    interface.closed = true;
    if (has_shared_node(interface, bodies_))  // which has one velocity
      interface.impulse = closing_impulse(interface, bodies_);
    choose_roles(static_cast<int>(i));
  }
}

void Controller::choose_roles(int number) {
  Coupling::Rule& rule = coupling_.rules[index(number)];
  if (rule.role_fixed) return;
  Interface& interface = coupling_.interfaces[index(number)];
  interface.kinematic = scene_.schwarz.parallel ? coarser_side(interface, bodies_)
                        : rule.tied             ? tied_side(interface, bodies_, scene_.time.window)
                                    : kinematic_side(interface, bodies_, scene_.time.window);
  rule.role_fixed = true;  // roles do not change during a run
  if (rule.tied || rule.published) return;
  const double limit = stable_step_in_contact(interface, bodies_, scene_.time.window);
  const Description& body = bodies_.describe(interface.neumann_side().body);
  if (body.step <= limit) return;
  emit(RunEvent::Kind::warning, time_, interface.name,
       fmt::format(
           "the contact spring of '{}' lowers the stable step of body '{}' to {:.4g} s: give "
           "it a smaller step, or its partner a softer contact_layer",
           interface.name, body.name, limit),
       {{"stable_step", limit}});
}

// ---- in a window that was tried -----------------------------------------------------------------

/// Sides that were free and met: from now on they are iterated.
std::optional<double> Controller::engage_touching() {
  std::optional<double> first;
  const double still = still_share * fastest_touch_;
  for (std::size_t i = 0; i < coupling_.interfaces.size(); ++i) {
    const Interface& interface = coupling_.interfaces[i];
    if (!coupling_.rules[i].unilateral() || interface.closed) continue;
    const std::optional<Touch> touch = first_overlap(interface, bodies_, still * shortest_step());
    if (!touch) continue;
    engage(static_cast<int>(i), touch->speed);
    first = std::min(first.value_or(touch->state), touch->state);
  }
  return first;
}

void Controller::engage(int number, double speed) {
  Interface& interface = coupling_.interfaces[index(number)];
  fastest_touch_ = std::max(fastest_touch_, speed);
  interface.closed = true;
  interface.closing_speed = std::max(speed, still_share * fastest_touch_);
  interface.force_scale = 0.0;
  choose_roles(number);
}

/// [N] of the window in history_: what the iteration leaves open is no force.
double Controller::least_force(const Interface& interface) const {
  return std::max(force_floor, scene_.schwarz.tolerance) *
         std::max(interface.force_scale, history_.peak());
}

/// Where the window must end so that contact is paid what an event in it has moved, before more
/// happens: at the first common end of substeps. A release of kick layers gives its impulse at the
/// end of the last kick.
std::optional<double> Controller::first_event(const TimeWindow& window) {
  std::optional<double> first;
  const double notable = notable_share * energy_guard_.most();
  for (std::size_t i = 0; i < coupling_.interfaces.size(); ++i) {
    Interface& interface = coupling_.interfaces[i];
    if (!coupling_.rules[i].unilateral() || !interface.closed) continue;
    history_.read(interface, bodies_);
    const double floor = least_force(interface);
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

/// First time in the window, from `time` on, at which substeps of all bodies end.
double Controller::common_end(const TimeWindow& window, double time) const {
  constexpr double rounding = 1.0e-6;  // of a substep
  const double coarsest = longest_step();
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

/// Kick layers that end their contact at the window's begin part with what they were owed.
bool Controller::release_kicks(const TimeWindow& window) {
  bool released = false;
  for (std::size_t i = 0; i < coupling_.interfaces.size(); ++i) {
    Interface& interface = coupling_.interfaces[i];
    if (!coupling_.rules[i].unilateral() || !interface.closed) continue;
    history_.read(interface, bodies_);
    if (!history_.kicks() || history_.size() < 2) continue;
    const double floor = least_force(interface);
    if (history_[0].force <= floor || history_[1].force > floor) continue;
    interface.impulse = std::exchange(interface.rebound_impulse, 0.0);
    interface.opened_at = window.begin;
    if (std::exchange(interface.pressed, false)) tell_opened(interface, history_.release(1));
    released = true;
  }
  return released;
}

/// Fewer substeps at once, fewer kinks in the map that is iterated.
bool Controller::shorten(TimeWindow& window) const {
  const bool unilateral = std::ranges::any_of(
      coupling_.interfaces, [](const Interface& i) { return i.closed && !i.bilateral; });
  const bool kinks = std::ranges::any_of(joints_, [](const Joint& joint) {
    return joint.interface->closed && joint.transmission->projects();
  });
  if (!unilateral || !kinks) return false;
  const double half = common_end(window, window.begin + 0.5 * window.length());
  if (half >= window.end) return false;
  window.end = half;
  return true;
}

// ---- in a window that was accepted --------------------------------------------------------------

/// What contact did in the window: its account, the impulse that pays it, and what is told of it.
void Controller::settle(const TimeWindow& window) {
  for (std::size_t i = 0; i < coupling_.interfaces.size(); ++i) {
    Interface& interface = coupling_.interfaces[i];
    if (!coupling_.rules[i].unilateral() || !interface.closed) continue;
    history_.read(interface, bodies_);
    interface.force_scale = std::max(interface.force_scale, history_.peak());
    force_reference_ = std::max(force_reference_, history_.peak());
    interface.debt -= contact_work(interface, bodies_);
    pay(interface);
    narrate(interface);
    disengage(interface, window);
  }
}

void Controller::pay(Interface& interface) {
  interface.rebound_impulse = release_impulse(interface, bodies_);
  const std::size_t last = history_.size() - 1;
  const bool active = history_[last].force > 0.0 || (last > 0 && history_[last - 1].force > 0.0);
  if (history_.kicks() || !active) return;  // bodies that are apart give each other nothing
  bool changed = false;
  for (std::size_t k = 1; k <= last && !changed; ++k)
    changed = (history_[k - 1].force > 0.0) != (history_[k].force > 0.0);
  const double least = (changed ? payable_share : notable_share) * energy_guard_.most();
  if (std::abs(interface.debt) <= least) return;
  interface.impulse = paying_impulse(interface, bodies_);
  for (const Side& side : interface.sides) bodies_.strike_record(side, interface.impulse);
}

/// Tells of the pushes that begin and end in the window.
void Controller::narrate(Interface& interface) {
  const double floor = std::max(least_force(interface), history_.rounding());
  const double bound = std::max(floor, pressing_share * force_reference_);
  for (std::size_t k = 1; k < history_.size(); ++k) {
    const ContactLevel& before = history_[k - 1];
    const ContactLevel& now = history_[k];
    if (now.force > floor && before.force <= floor) {
      const Touch touch = history_.touch(k);
      interface.touched_at = touch.time;
      interface.touch_speed = touch.speed;
      fastest_touch_ = std::max(fastest_touch_, touch.speed);
    }
    const bool fast = interface.touch_speed > grazing_share * fastest_touch_;
    if (!interface.pressed && now.force > floor && (fast || now.force > bound)) {
      interface.pressed = true;
      const double begin = fast ? interface.touched_at : history_.crossing(k, bound);
      interface.closing_speed = std::max(interface.touch_speed, still_share * fastest_touch_);
      tell_closed(interface, begin, interface.touch_speed);
    } else if (interface.pressed && now.force <= floor) {
      interface.pressed = false;
      tell_opened(interface, history_.release(k));
    }
  }
}

/// Sides that have parted are free again.
void Controller::disengage(Interface& interface, const TimeWindow& window) {
  const double gap = history_[history_.size() - 1].gap;
  const bool apart = gap > grazing_share * fastest_touch_ * window.length();
  if (!apart || peak_force(interface, bodies_) > 0.0 || interface.pressed) return;
  interface.closed = false;
}

void Controller::tell_closed(const Interface& interface, double time, double speed) {
  emit(RunEvent::Kind::contact_closed, time, interface.name,
       fmt::format("contact '{}' closes at {:.6g} m/s; kinematic side: {}", interface.name, speed,
                   bodies_.describe(interface.kinematic_side().body).name),
       {{"closing_speed", speed}});
}

void Controller::tell_opened(const Interface& interface, double time) {
  emit(RunEvent::Kind::contact_opened, time, interface.name,
       fmt::format("contact '{}' opens", interface.name), {{"release_impulse", interface.impulse}});
}

}  // namespace abut
