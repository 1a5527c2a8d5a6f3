// How a body that is not linear would go on as its tangent has it: first guesses of partners, for a
// solve a step.

#include <cmath>

#include "subdomain_solver/time/implicit_dynamics.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

/// That of the last correction of the step before, or where there was none of the present motion.
/// Steps of windows differ in their last bits.
bool ImplicitDynamics::hold_tangent(const Motion& motion, double time, double dt) {
  if (std::abs(factored_dt_ - dt) <= 1.0e-9 * dt) return true;
  Model& model = *problem_.model;
  ModelResponse& here = buffers_.tangent;
  if (!model.evaluate(motion.q, motion.history, Model::Want::tangent, here)) return false;
  for (const std::unique_ptr<Load>& load : problem_.loads)
    load->add_tangent(time, motion.q, here.tangent);
  free_.extract(whole_.of(1.0, mass_, 0.25 * dt * dt, here.tangent), matrix_);
  factored_dt_ = 0.0;
  if (!solver_->factor(matrix_)) return false;
  factored_dt_ = dt;
  contact_.forget();
  return true;
}

bool ImplicitDynamics::foresee(const Motion& motion, double time, double dt, Foreseen& beside) {
  const auto q = view(motion.q);
  if (beside.steps == 0) {
    beside.u.setZero(q.size());
    beside.v = view(motion.v);
  }
  if (!hold_tangent(motion, time, dt)) return false;
  Buffers& b = buffers_;
  b.a.setZero(q.size());
  for (const Prescribed& p : problem_.supports)
    b.a(p.dof) =
        4.0 / (dt * dt) * (p.value(time + dt) - q(p.dof) - beside.u(p.dof) - dt * beside.v(p.dof));
  b.moved = 2.0 * beside.u + dt * beside.v + 0.25 * dt * dt * b.a;
  b.sum.noalias() = b.tangent.tangent * b.moved;
  b.sum += 2.0 * view(motion.force);
  times_mass(b.a, b.inertia);
  b.sum += b.inertia;
  b.sum -= problem_.external_force(time, motion.q);
  b.sum -= problem_.external_force(time + dt, motion.q);
  free_.pick(b.sum, b.x);
  if (!solver_->solve(b.x, b.free)) return false;
  b.free = -b.free;
  free_.add(b.free, b.a);
  beside.u += dt * beside.v + 0.25 * dt * dt * b.a;
  beside.v += 0.5 * dt * b.a;
  beside.q = motion.q;
  view(beside.q) += beside.u;
  ++beside.steps;
  return true;
}

}  // namespace abut
