#include "coordinator/contact_events.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "coordinator/coupling/exchange.hpp"
#include "coordinator/coupling/sprung_sides.hpp"

namespace abut {

namespace {

bool has_shared_node(const Joint& joint, const Bodies& bodies) {
  return std::ranges::all_of(joint.sides, [&bodies](const Side& side) {
    return std::isinf(bodies.describe(side.body).mass) || bodies.port(side).tied;
  });
}

}  // namespace

void ContactEvents::start() {
  roles_.start(joints_);
  for (Joint& joint : joints_)
    if (joint.tied()) joint.press();
  const std::vector<bool> share = share_nodes(joints_);
  for (std::size_t j = 0; j < joints_.size(); ++j)
    if (share[j] && has_shared_node(joints_[j], bodies_)) open(joints_[j]);
}

void ContactEvents::engage_sprung(double time) {
  for (Joint& joint : joints_) {
    if (joint.exchange == nullptr || joint.closed() || !sprang_together(joint, bodies_)) continue;
    engage(joint, {.speed = joint.watch->approach(joint, bodies_).speed, .presses = true}, time);
  }
}

/// A shared node has one velocity. Where it is kicked, it has that half a step before the begin
/// too: both ends know nothing of each other's force there, and their energies do not hold it
/// [M.123].
void ContactEvents::open(Joint& joint) {
  const double closing = closing_impulse(joint, bodies_), kick = opening_kick(joint, bodies_);
  for (const Side& side : joint.sides) bodies_.strike_energy(side, closing, kick);
  joint.contact.impulse = closing + kick;
}

void ContactEvents::begin(const TimeWindow& window) {
  for (Joint& joint : joints_) {
    const std::optional<Engagement> now = joint.watch->begin(joint, window, bodies_, changes_);
    narrate(joint);
    if (now) engage(joint, *now, window.begin);
  }
}

void ContactEvents::engage(Joint& joint, const Engagement& how, double time) {
  run_.fastest_touch = std::max(run_.fastest_touch, how.speed);
  joint.exchange->introduce(joint, bodies_);
  joint.engage(std::max(how.speed, run_.still()));
  if (roles_.choose(joint) && joint.deciding()) {
    const double limit = stable_step_in_contact(joint, bodies_, window_);
    if (bodies_.describe(joint.neumann_side().body).step > limit)
      narrator_.lowered_step(joint, time, limit);
  }
  if (!how.presses) return;
  joint.press();
  joint.contact.impulse = how.impulse;
  narrator_.closed(joint, time, how.speed);
}

/// Observers hear what has changed at a joint.
void ContactEvents::narrate(const Joint& joint) {
  for (const ContactChange& change : changes_) {
    if (joint.exchange == nullptr) {
      narrator_.inside(joint, change);
    } else if (change.closes) {
      narrator_.closed(joint, change.time, change.speed);
    } else {
      narrator_.opened(joint, change.time);
    }
  }
  changes_.clear();
}

// ---- in a window that was tried -----------------------------------------------------------------

std::optional<double> ContactEvents::engage_touching(const TimeWindow& window) {
  std::optional<double> first;
  const double least = negligible();
  for (Joint& joint : joints_) {
    if (joint.closed()) continue;
    const std::optional<Engagement> met = joint.watch->touch(joint, window, bodies_, least);
    if (!met) continue;
    engage(joint, *met, window.begin);
    first = std::min(first.value_or(met->end), met->end);
  }
  return first;
}

std::optional<double> ContactEvents::first_event(const TimeWindow& window, double energy) {
  std::optional<double> first;
  for (const Joint& joint : joints_) {
    ContactAccount* account = joint.watch->account();
    if (account == nullptr || !joint.closed()) continue;  // the others need no cut
    const std::optional<double> at = account->event(joint, energy, run_, bodies_);
    if (!at) continue;
    const double end = *at > window.begin ? common_end(window, *at) : *at;
    first = std::min(first.value_or(end), end);
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

TimeWindow ContactEvents::even(const TimeWindow& window) const {
  constexpr double rounding = 1.0e-6;  // of a step
  const bool tied = std::ranges::any_of(joints_, [this](const Joint& joint) {
    return joint.tied() && bodies_.port(joint.sides[0]).geometry.dim > 1;
  });
  TimeWindow part = window;
  for (int b = 0; tied && b < bodies_.count(); ++b) {
    const double step = bodies_.describe(b).step;
    const double count = step > 0.0 ? part.length() / step : 0.0,
                 whole = std::floor(count + rounding);
    if (whole < 1.0 || count - whole <= rounding) continue;
    part.end = part.begin + whole * step;
    b = -1;  // others' steps may no longer fit
  }
  return part;
}

bool ContactEvents::release_kicks(const TimeWindow& window) {
  bool released = false;
  for (Joint& joint : joints_) {
    ContactAccount* account = joint.watch->account();
    if (account == nullptr || !joint.closed()) continue;
    if (account->release_kick(joint, window, run_, bodies_, changes_)) released = true;
    narrate(joint);
  }
  return released;
}

std::optional<double> ContactEvents::earlier_end(const TimeWindow& window) const {
  const bool unilateral =
      std::ranges::any_of(joints_, [](const Joint& j) { return j.closed() && !j.tied(); });
  const bool kinks = std::ranges::any_of(
      joints_, [](const Joint& joint) { return joint.closed() && joint.exchange->projects(); });
  if (!unilateral || !kinks) return std::nullopt;
  const double half = common_end(window, window.begin + 0.5 * window.length());
  return half < window.end ? std::optional(half) : std::nullopt;
}

double ContactEvents::payments(double energy) {
  double sum = 0.0;
  for (const Joint& joint : joints_)
    if (ContactAccount* account = joint.watch->account(); account != nullptr && joint.closed())
      sum += account->payment(joint, energy, bodies_);
  return sum;
}

double ContactEvents::overpaid(double energy) {
  double sum = 0.0;
  for (const Joint& joint : joints_)
    if (ContactAccount* account = joint.watch->account(); account != nullptr && joint.closed())
      sum += account->overpaid(joint, energy, bodies_);
  return sum;
}

void ContactEvents::repaid(double energy, double joules) {
  const double all = overpaid(energy);
  if (!(all > 0.0)) return;
  for (const Joint& joint : joints_)
    if (ContactAccount* account = joint.watch->account(); account != nullptr && joint.closed())
      account->repaid(joules * account->overpaid(joint, energy, bodies_) / all);
}

// ---- in a window that was accepted --------------------------------------------------------------

void ContactEvents::settle(const TimeWindow& window, double energy) {
  for (Joint& joint : joints_) {
    joint.contact.impulse = 0.0;
    joint.watch->settle(joint, window, energy, run_, bodies_, changes_);
    narrate(joint);
  }
}

void ContactEvents::settle_passively(const TimeWindow& window, double energy) {
  for (Joint& joint : joints_) {
    if (ContactAccount* account = joint.watch->account()) {
      if (joint.closed()) account->settle_passively(joint, window, run_, bodies_, changes_);
    } else {
      joint.watch->settle(joint, window, energy, run_, bodies_, changes_);
    }
    narrate(joint);
  }
}

}  // namespace abut
