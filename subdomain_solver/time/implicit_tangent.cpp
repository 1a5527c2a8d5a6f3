// Tangents that serve for more than a correction: those that a motion remembers, and how a body
// that is not linear would go on as its tangent has it, first guesses of partners, for a solve a
// step.

#include <cmath>
#include <utility>

#include "subdomain_solver/time/implicit_dynamics.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

bool ImplicitDynamics::factor(const SparseMatrix& whole, double dt) {
  free_.extract(whole, matrix_);
  factored_dt_ = 0.0;
  factored_.clear();
  if (!solver_->factor(matrix_)) return false;
  factored_dt_ = dt;
  contact_.forget();
  return true;
}

bool ImplicitDynamics::keeps_factors() const {
  const Model& model = *problem_.model;
  return !model.is_linear() && model.history_size() == 0 && free_.count() >= options_.keeps_from;
}

/// A step begins. Whether its corrections are by factors of the state that the motion remembers; by
/// those of its own begin where it remembers none, or another step (steps of windows differ in
/// their last bits).
bool ImplicitDynamics::remember(const Motion& motion, double dt) {
  const Model* model = problem_.model;
  const bool same_model = std::exchange(factored_model_, model) == model;
  const bool keeps = keeps_factors();
  if (keeps) {
    const std::vector<double>& told = motion.control;
    if (told.size() == motion.q.size() + 1 && std::abs(told.front() - dt) <= 1.0e-9 * dt) {
      remembered_ = told;
    } else {
      remembered_.assign(1, dt);
      remembered_.insert(remembered_.end(), motion.q.begin(), motion.q.end());
    }
  }
  // Factors of another state would leave their rounding in contact's turns.
  const bool here = keeps ? factored_ == remembered_ : model->is_linear();
  if (!here || !same_model) {
    factored_dt_ = 0.0;
    factored_.clear();
  }
  return keeps;
}

/// Without the stiffness of loads that follow the body, which is of the time as well.
bool ImplicitDynamics::factor_remembered() {
  if (!factored_.empty()) return true;  // of this step, which has cleared others
  const AlphaWeights& w = options_.weights;
  const double dt = remembered_.front();
  ModelResponse& there = buffers_.tangent;
  const std::span<const double> q = std::span<const double>(remembered_).subspan(1);
  if (!problem_.model->evaluate(q, {}, Model::Want::tangent, there)) return false;
  const double share = (1.0 - w.alpha_f) * w.beta * dt * dt;
  if (!factor(whole_.of(1.0 - w.alpha_m, mass_, share, there.tangent), dt)) return false;
  factored_ = remembered_;
  return true;
}

/// That of the last correction of the step before, or where there was none of the present motion.
/// Steps of windows differ in their last bits.
bool ImplicitDynamics::hold_tangent(const Motion& motion, double time, double dt) {
  if (std::abs(factored_dt_ - dt) <= 1.0e-9 * dt) return true;
  Model& model = *problem_.model;
  ModelResponse& here = buffers_.tangent;
  if (!model.evaluate(motion.q, motion.history, Model::Want::tangent, here)) return false;
  for (const std::unique_ptr<Load>& load : problem_.loads)
    load->add_tangent(time, motion.q, here.tangent);
  return factor(whole_.of(1.0, mass_, 0.25 * dt * dt, here.tangent), dt);
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
