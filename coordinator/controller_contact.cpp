#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "coordinator/controller.hpp"
#include "coordinator/coupling/contact.hpp"
#include "coordinator/coupling/roles.hpp"

namespace abut {

namespace {

constexpr double force_floor = 1.0e-9;  // of the largest contact force: less is no compression

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

}  // namespace abut
