#include "subdomain_solver/time/drift_kick_drift.hpp"

#include <cmath>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

DriftKickDrift::DriftKickDrift(const Problem& problem, double step)
    : Integrator({.inertia = this, .foreseeing = this}),
      problem_(problem),
      step_(step),
      inverse_mass_(problem.model->lumped_mass().cwiseInverse()) {
  ABUT_ASSERT(problem.model->massless().empty());
  for (const Prescribed& p : problem_.supports) inverse_mass_(p.dof) = 0.0;
}

void DriftKickDrift::find_loads(double time, std::span<const double> q) {
  loads_.setZero(problem_.model->dofs());
  for (const std::unique_ptr<Load>& load : problem_.loads) load->add(time, q, loads_);
}

DriftKickDrift::Known* DriftKickDrift::respond(const std::vector<double>& history) {
  const auto fits = [&](const Known& known) {
    return history.empty() && known.holds && known.at == middle_;
  };
  if (fits(known_[1])) std::swap(known_[0], known_[1]);
  if (fits(known_[0])) return &known_[0];
  std::swap(known_[0], known_[1]);
  known_[0].holds = false;
  if (!problem_.model->evaluate(middle_, history, Model::Want::force, known_[0].response))
    return nullptr;
  known_[0].at.swap(middle_);
  known_[0].holds = true;
  return &known_[0];
}

/// The stored energy is that of the scheme's invariant: as if a step lay behind.
std::optional<Failed> DriftKickDrift::begin(Motion& motion, double time) {
  motion.history.resize(problem_.model->history_size(), 0.0);
  for (const Prescribed& p : problem_.supports) motion.q[p.dof] = p.value(time);
  middle_ = motion.q;
  view(middle_) -= 0.5 * step_ * view(motion.v);
  const Known* known = respond(motion.history);
  if (known == nullptr) return failed_newton({NewtonReport::End::inadmissible}, time);
  const ModelResponse* response = &known->response;
  store(response->force, motion.force);
  motion.stored = response->stored + 0.5 * step_ * response->force.dot(view(motion.v));
  find_loads(time, motion.q);
  motion.a.resize(motion.q.size());
  view(motion.a) = inverse_mass_.cwiseProduct(loads_ - response->force);
  return std::nullopt;
}

void DriftKickDrift::strike(Motion& motion, const Vector& impulse) {
  view(motion.v) += inverse_mass_.cwiseProduct(impulse);
}

bool DriftKickDrift::find_middle(const Motion& motion, double time, double dt) {
  middle_.resize(motion.q.size());
  view(middle_) = view(motion.q) + 0.5 * dt * view(motion.v);
  given_.clear();
  for (const Prescribed& p : problem_.supports) {
    const double value = given_.emplace_back(p.value(time + dt));
    if (!std::isfinite(value)) return false;
    middle_[p.dof] = 0.5 * (motion.q[p.dof] + value);
  }
  return true;
}

/// Of the first step, whose force is that of the step that may follow.
bool DriftKickDrift::foresee(const Motion& motion, double time, double dt, Foreseen& ahead) {
  const double half = 0.5 * dt;
  if (ahead.steps > 0 || !motion.history.empty() || !find_middle(motion, time, dt)) return false;
  const Known* known = respond(motion.history);
  if (known == nullptr) return false;
  find_loads(time + half, known->at);
  ahead.q.resize(motion.q.size());
  view(ahead.q) =
      view(known->at) +
      half * (view(motion.v) + dt * inverse_mass_.cwiseProduct(loads_ - known->response.force));
  for (std::size_t k = 0; k < given_.size(); ++k) ahead.q[problem_.supports[k].dof] = given_[k];
  ++ahead.steps;
  return true;
}

std::optional<Failed> DriftKickDrift::step(Motion& motion, double time, double dt) {
  const double half = 0.5 * dt;
  if (!find_middle(motion, time, dt)) return not_finite(time + dt);
  Known* known = respond(motion.history);
  if (known == nullptr) return failed_newton({NewtonReport::End::inadmissible}, time + half);
  ModelResponse* response = &known->response;
  find_loads(time + half, known->at);
  double work = 0.0;
  const double *inverse = inverse_mass_.data(), *r = response->force.data(), *load = loads_.data();
  const double* middle = known->at.data();
  double *q = motion.q.data(), *v = motion.v.data(), *a = motion.a.data();
  store(response->force, motion.force);
  for (std::size_t i = 0; i < motion.q.size(); ++i) {
    if (inverse[i] == 0.0) continue;
    a[i] = inverse[i] * (load[i] - r[i]);
    v[i] += dt * a[i];
    const double next = middle[i] + half * v[i];
    work += load[i] * (next - q[i]);
    q[i] = next;
  }
  for (std::size_t k = 0; k < given_.size(); ++k) {  // as ExplicitDynamics moves them
    const std::size_t i = index(problem_.supports[k].dof);
    const double moved = given_[k] - q[i], before = v[i];
    const double mass = problem_.model->lumped_mass()(problem_.supports[k].dof);
    v[i] = moved / dt;
    a[i] = (v[i] - before) / dt;
    work += r[i] * moved + 0.5 * mass * (v[i] * v[i] - before * before);
    q[i] = given_[k];
  }
  motion.external_work += work;
  motion.dissipated += response->dissipation;
  motion.stored = response->stored + half * response->force.dot(view(motion.v));
  if (!motion.history.empty()) motion.history.swap(response->history);
  return std::nullopt;
}

void DriftKickDrift::acceleration(const Motion& motion, double, double, const Vector&,
                                  Vector& out) const {
  out = view(motion.a);
}

double DriftKickDrift::kinetic(const Motion& motion) const {
  const auto v = view(motion.v);
  return 0.5 * v.dot(problem_.model->lumped_mass().cwiseProduct(v));
}

}  // namespace abut
