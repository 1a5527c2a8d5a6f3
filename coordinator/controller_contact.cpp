#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "coordinator/controller.hpp"
#include "coordinator/coupling/contact.hpp"
#include "coordinator/coupling/roles.hpp"

namespace abut {

namespace {

constexpr double force_floor = 1.0e-9;  // of the largest contact force: less is no compression
// Of the fastest first touch: what meets more slowly is not located. The overlap of a substep at
// that speed holds its square, 1e-4, of the energy that a cell brings along.
constexpr double grazing_share = 1.0e-2;
// Of the largest contact force of the run: what presses less only touches. Forerunners of a front
// reach a few per cent.
constexpr double pressing_share = 0.05;

}  // namespace

void Controller::apply_criteria_at_start(const TimeWindow& window) {
  for (std::size_t i = 0; i < coupling_.interfaces.size(); ++i) {
    if (!coupling_.rules[i].published || coupling_.rules[i].tied) continue;
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
  // what the iteration leaves open is no force
  const double floor = std::max(force_floor, scene_.schwarz.tolerance);
  for (std::size_t i = 0; i < coupling_.interfaces.size(); ++i) {
    if (!coupling_.rules[i].located()) continue;
    const Interface& interface = coupling_.interfaces[i];
    if (!interface.closed) {
      if (const std::optional<Closing> c = overlap_criterion(interface, bodies_)) {
        events.push_back({static_cast<int>(i), true, c->time, c->time, c->speed});
      }
      continue;
    }
    if (interface.loose()) continue;
    const double scale = std::max(interface.force_scale, peak_force(interface, bodies_));
    if (const std::optional<Opening> o = compression_criterion(interface, bodies_, floor * scale)) {
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

/// Tied interfaces are closed before the first window and for the whole run.
void Controller::tie() {
  for (std::size_t i = 0; i < coupling_.interfaces.size(); ++i) {
    if (!coupling_.rules[i].tied) continue;
    Interface& interface = coupling_.interfaces[i];
    interface.closed = true;
    interface.release_impulse = closing_impulse(interface, bodies_);  // the node has one velocity
    choose_roles(static_cast<int>(i));
  }
}

void Controller::choose_roles(int index) {
  Coupling::Rule& rule = coupling_.rules[static_cast<std::size_t>(index)];
  if (rule.role_fixed) return;
  Interface& interface = coupling_.interfaces[static_cast<std::size_t>(index)];
  interface.kinematic = scene_.schwarz.parallel ? coarser_side(interface, bodies_)
                        : rule.tied             ? tied_side(interface, bodies_, scene_.time.window)
                                    : kinematic_side(interface, bodies_, scene_.time.window);
  rule.role_fixed = true;  // roles do not change during a run
}

void Controller::close(int index, double time, double speed) {
  Interface& interface = coupling_.interfaces[static_cast<std::size_t>(index)];
  interface.closed = true;
  interface.closing_speed = speed;
  interface.force_scale = 0.0;
  if (coupling_.rules[static_cast<std::size_t>(index)].projection)
    interface.release_impulse = std::max(0.0, closing_impulse(interface, bodies_));
  choose_roles(index);
  fastest_closing_ = std::max(fastest_closing_, speed);
  interface.pressed = true;
  tell_closed(interface, time);
}

void Controller::tell_closed(const Interface& interface, double time) {
  emit(RunEvent::Kind::contact_closed, time, interface.name,
       fmt::format("contact closes at {:.6g} m/s; kinematic side: {}", interface.closing_speed,
                   bodies_.describe(interface.kinematic_side().body).name),
       {{"closing_speed", interface.closing_speed}});
}

void Controller::tell_opened(const Interface& interface, double time) {
  emit(RunEvent::Kind::contact_opened, time, interface.name, "contact opens",
       {{"release_impulse", interface.release_impulse}});
}

void Controller::apply(const Event& event) {
  if (event.closes) return close(event.interface, event.located, event.speed);
  Interface& interface = coupling_.interfaces[static_cast<std::size_t>(event.interface)];
  interface.closed = false;
  interface.opened_at = event.state;
  interface.release_impulse = interface.rebound_impulse;
  interface.rebound_impulse = 0.0;
  interface.pressed = false;
  tell_opened(interface, event.located);
}

// ---- loose contact: touching, or coming and going faster than windows can be cut ----------------

void Controller::loosen(int index, double speed) {
  Interface& interface = coupling_.interfaces[static_cast<std::size_t>(index)];
  if (!interface.closed) {
    interface.closed = true;
    interface.closing_speed = speed;
    interface.force_scale = 0.0;
    choose_roles(index);
  }
  interface.bilateral = false;
}

/// Sides that meet so slowly that not locating it costs nothing: forerunners of a numerical front
/// at faces that touch, faces that graze.
bool Controller::loosen_grazing() {
  bool loosened = false;
  for (std::size_t i = 0; i < coupling_.interfaces.size(); ++i) {
    const Interface& interface = coupling_.interfaces[i];
    if (!coupling_.rules[i].located() || interface.closed) continue;
    const std::optional<Closing> closing = overlap_criterion(interface, bodies_);
    if (!closing || closing->speed > grazing_share * fastest_closing_) continue;
    loosen(static_cast<int>(i), closing->speed);
    loosened = true;
  }
  return loosened;
}

/// No more events are located, every substep decides for itself. Leaving the sides free instead
/// would let them overlap, and closing an overlap later would make energy out of nothing.
void Controller::loosen_chattering(const TimeWindow& window) {
  std::string first;
  for (std::size_t i = 0; i < coupling_.interfaces.size(); ++i) {
    Interface& interface = coupling_.interfaces[i];
    if (!coupling_.rules[i].located() || interface.loose()) continue;
    if (!interface.closed) {
      const std::optional<Closing> closing = overlap_criterion(interface, bodies_);
      if (!closing) continue;
      close(static_cast<int>(i), window.begin, closing->speed);
    }
    loosen(static_cast<int>(i), interface.closing_speed);
    if (first.empty()) first = interface.name;
  }
  events_here_ = 0;
  emit(RunEvent::Kind::warning, window.begin, first,
       fmt::format("contact changed more than {} times within a window: every substep decides for "
                   "itself until it is quiet",
                   most_events));
}

/// Fewer substeps at once, fewer kinks in the map that is iterated.
bool Controller::shorten_loose(TimeWindow& window) const {
  const bool loose = std::ranges::any_of(coupling_.interfaces, &Interface::loose);
  const double fewer = std::floor(0.5 * window.length() / longest_step() + 0.25) * longest_step();
  if (!loose || fewer <= 0.0 || fewer >= 0.75 * window.length()) return false;
  window.end = window.begin + fewer;
  return true;
}

/// What an accepted window says of loose contact: it presses, it is quiet, or its sides have
/// parted.
void Controller::settle(const TimeWindow& window) {
  for (const Interface& interface : coupling_.interfaces) {
    if (interface.closed) force_reference_ = std::max(force_reference_, interface.force_scale);
  }
  for (Interface& interface : coupling_.interfaces) {
    if (!interface.loose()) continue;
    const Waveform& trace = trace_of(bodies_, interface.kinematic_side());
    const double inward = -interface.normal_of(interface.kinematic);
    const double bound = pressing_share * force_reference_;
    const bool presses = inward * trace.f.back() > bound;
    std::size_t at = trace.size() - 1;  // first of the substeps that are as the last one is
    while (at > 0 && (inward * trace.f[at - 1] > bound) == presses) --at;
    if (presses) {
      interface.bilateral = true;
      if (!std::exchange(interface.pressed, true)) tell_closed(interface, trace.time[at]);
      continue;
    }
    if (std::exchange(interface.pressed, false)) {
      interface.release_impulse = std::exchange(interface.rebound_impulse, 0.0);
      tell_opened(interface, trace.time[at]);
    }
    const double u0 = trace_of(bodies_, interface.sides[0]).u.back();
    const double u1 = trace_of(bodies_, interface.sides[1]).u.back();
    const bool apart = interface.gap(u0, u1) > grazing_share * fastest_closing_ * window.length();
    if (!apart || peak_force(interface, bodies_) > 0.0) continue;
    interface.closed = false;
    interface.bilateral = true;
    interface.opened_at = window.end;
  }
}

}  // namespace abut
