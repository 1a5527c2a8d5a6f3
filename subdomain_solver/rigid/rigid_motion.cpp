#include "subdomain_solver/rigid/rigid_motion.hpp"

#include <cmath>

#include <fmt/format.h>

#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

namespace {

/// [rad] in one step: beyond it the attitude has lost five digits, and the series cost seconds.
constexpr double most_turn = 1.0e5;

}  // namespace

std::optional<Failed> RigidMotion::begin(Motion& motion, double time) {
  motion.a.assign(motion.v.size(), 0.0);
  motion.force.assign(motion.v.size(), 0.0);
  load(motion, time);
  return std::nullopt;
}

std::optional<Failed> RigidMotion::step(Motion& motion, double time, double dt) {
  next_ = motion;
  load(next_, time);
  kick(next_, 0.5 * dt);
  const double turn = body_.fastest_turn(next_.q, next_.v) * dt;
  if (!std::isfinite(turn)) {
    return Failed{Failed::Cause::non_finite, time,
                  "the state is not a number any more: take a smaller step"};
  }
  if (turn > most_turn) {
    return Failed{Failed::Cause::step_too_small, time,
                  fmt::format("the body may turn by {:g} rad in a step, and {:g} rad are the most: "
                              "take a smaller step",
                              turn, most_turn)};
  }
  body_.drift(next_.q, next_.v, dt);
  load(next_, time + dt);
  kick(next_, 0.5 * dt);
  next_.step = dt;
  std::swap(motion, next_);
  return std::nullopt;
}

/// Rates of v under the loads at a time.
void RigidMotion::load(Motion& motion, double time) const {
  if (problem_.loads.empty()) return;
  const Vector& force = problem_.external_force(time, motion.q);
  view(motion.a) = force.cwiseQuotient(body_.lumped_mass());
}

/// Changes the momenta by forces over a time. At one place v is linear in the forces, and so is the
/// power: its mean is exact.
void RigidMotion::kick(Motion& motion, double time) {
  if (problem_.loads.empty()) return;
  force_ = body_.lumped_mass().cwiseProduct(view(motion.a));
  const double before = body_.power(motion.q, motion.v, force_);
  view(motion.v) += time * view(motion.a);
  const double after = body_.power(motion.q, motion.v, force_);
  motion.external_work += 0.5 * time * (before + after);
}

}  // namespace abut
