#include "subdomain_solver/time/explicit_dynamics.hpp"

#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

ExplicitDynamics::ExplicitDynamics(const Problem& problem)
    : problem_(problem), mass_(problem.model->lumped_mass()) {}

void ExplicitDynamics::accelerate(double time, const ModelResponse& response,
                                  Motion& motion) const {
  view(motion.a) = (problem_.external_force(time, motion.q) - response.force).cwiseQuotient(mass_);
  for (const Prescribed& p : problem_.supports) motion.a[static_cast<std::size_t>(p.dof)] = 0.0;
}

std::optional<Failed> ExplicitDynamics::begin(Motion& motion, double time) {
  motion.history.resize(problem_.model->history_size(), 0.0);
  motion.a.assign(motion.q.size(), 0.0);
  for (const Prescribed& p : problem_.supports)
    motion.q[static_cast<std::size_t>(p.dof)] = p.value(time);
  if (!problem_.model->evaluate(motion.q, motion.history, Model::Want::force, response_))
    return failed_newton({NewtonReport::End::inadmissible}, time);
  store(response_.force, motion.force);
  motion.stored = response_.stored;
  accelerate(time, response_, motion);
  return std::nullopt;
}

std::optional<Failed> ExplicitDynamics::step(Motion& motion, double time, double dt) {
  const Motion before = motion;
  view(motion.v) += 0.5 * dt * view(motion.a);
  view(motion.q) += dt * view(motion.v);
  for (const Prescribed& p : problem_.supports) {
    const std::size_t i = static_cast<std::size_t>(p.dof);
    motion.q[i] = p.value(time + dt);
    motion.v[i] = (motion.q[i] - before.q[i]) / dt;
  }
  if (!problem_.model->evaluate(motion.q, motion.history, Model::Want::force, response_)) {
    motion = before;
    return failed_newton({NewtonReport::End::inadmissible}, time + dt);
  }
  // Loads and supports do the work that inertia and internal force take; the velocity of the half
  // step is that of the whole one.
  const Vector moved = view(motion.q) - view(before.q);
  motion.history.swap(response_.history);
  motion.dissipated += response_.dissipation;
  motion.stored = response_.stored;
  store(response_.force, motion.force);
  accelerate(time + dt, response_, motion);
  view(motion.v) += 0.5 * dt * view(motion.a);
  const Vector external = 0.5 * (mass_.cwiseProduct(view(before.a) + view(motion.a)) +
                                 view(before.force) + view(motion.force));
  motion.external_work += external.dot(moved);
  return std::nullopt;
}

double ExplicitDynamics::kinetic(const Motion& motion) const {
  const auto v = view(motion.v);
  return 0.5 * v.dot(mass_.cwiseProduct(v));
}

}  // namespace abut
