#include "subdomain_solver/time/explicit_dynamics.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

ExplicitDynamics::ExplicitDynamics(const Problem& problem, double step)
    : Integrator(
          {.inertia = this, .layer = problem.model->massless().empty() ? nullptr : &layer_}),
      problem_(problem),
      nominal_step_(step),
      layer_(problem),
      inverse_mass_(problem.model->lumped_mass().cwiseInverse()) {
  for (const int dof : layer_.dofs()) inverse_mass_(dof) = 0.0;
  if (!layer_.empty()) answer_.setZero(problem.model->dofs());
  for (const Prescribed& p : problem_.supports) inverse_mass_(p.dof) = 0.0;
}

template <class Update>
void ExplicitDynamics::update_all(std::size_t count, const Update& update) {
  constexpr std::size_t length = 16384;  // 128 kB of each vector
  const std::size_t ranges = (count + length - 1) / length;
  work_.resize(ranges);
  const auto one = [&update, count](std::size_t range, int) {
    update(range, Range{range * length, std::min(count, (range + 1) * length)});
  };
  if (WorkerThreads* threads = problem_.model->threads()) {
    threads->run(ranges, one);
  } else {
    for (std::size_t range = 0; range < ranges; ++range) one(range, 0);
  }
}

void ExplicitDynamics::find_loads(double time, std::span<const double> q) {
  if (problem_.loads.empty()) return;
  loads_.setZero(problem_.model->dofs());
  for (const std::unique_ptr<Load>& load : problem_.loads) load->add(time, q, loads_);
}

std::optional<Failed> ExplicitDynamics::begin(Motion& motion, double time) {
  motion.history.resize(problem_.model->history_size(), 0.0);
  for (const Prescribed& p : problem_.supports) motion.q[p.dof] = p.value(time);
  if (!layer_.empty()) {
    find_loads(time, motion.q);
    if (auto failed = layer_.settle(time, motion.q, motion.history, loads_, nullptr)) return failed;
  }
  if (!problem_.model->evaluate(motion.q, motion.history, Model::Want::force, response_))
    return failed_newton({NewtonReport::End::inadmissible}, time);
  layer_.complete(response_.force);
  store(response_.force, motion.force);
  motion.stored = response_.stored;
  find_loads(time, motion.q);
  motion.a.resize(motion.q.size());
  view(motion.a) = -inverse_mass_.cwiseProduct(response_.force);
  if (loads_.size() > 0) view(motion.a) += inverse_mass_.cwiseProduct(loads_);
  motion.step = nominal_step_;
  return std::nullopt;
}

void ExplicitDynamics::predict(const Motion& motion, double dt, Range range) {
  const double *q = motion.q.data(), *v = motion.v.data(), *a = motion.a.data();
  double* next = next_.data();
  const double half = 0.5 * dt;
  for (std::size_t i = range.begin; i < range.end; ++i) next[i] = q[i] + dt * (v[i] + half * a[i]);
}

/// Accelerations, velocities and forces of the step's end. Returns the work of the loads: the mean
/// of theirs at both ends, of which that at the begin is what inertia and internal force took.
double ExplicitDynamics::correct(Motion& motion, double dt, Range range) const {
  double* __restrict v = motion.v.data(), * __restrict a = motion.a.data();
  double* __restrict force = motion.force.data();
  const double* __restrict inverse = inverse_mass_.data(), *r = response_.force.data();
  const double half = 0.5 * dt;
  if (loads_.size() == 0) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const double acceleration = -(inverse[i] * r[i]);
      v[i] = (v[i] + half * a[i]) + half * acceleration;
      a[i] = acceleration;
      force[i] = r[i];
    }
    return 0.0;
  }
  const double *mass = problem_.model->lumped_mass().data(), *load = loads_.data();
  double work = 0.0;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const double acceleration = inverse[i] * (load[i] - r[i]);
    const double before = inverse[i] != 0.0 ? mass[i] * a[i] + force[i] : 0.0;
    const double now = inverse[i] != 0.0 ? load[i] : 0.0;
    work += 0.5 * (before + now) * (next_[i] - motion.q[i]);
    v[i] = (v[i] + half * a[i]) + half * acceleration;
    a[i] = acceleration;
    force[i] = r[i];
  }
  return work;
}

/// Prescribed coordinates move from value to value; their reaction does work, on the body and on
/// their own mass. The velocity of the half step is that of the whole one.
double ExplicitDynamics::correct_supports(Motion& motion, double dt) const {
  double work = 0.0;
  for (const Prescribed& p : problem_.supports) {
    const std::size_t i = index(p.dof);
    const double moved = next_[i] - motion.q[i], before = motion.v[i];
    motion.v[i] = moved / dt;
    work +=
        0.5 * (motion.force[i] + response_.force(p.dof)) * moved +
        0.5 * problem_.model->lumped_mass()(p.dof) * (motion.v[i] * motion.v[i] - before * before);
  }
  return work;
}

/// What acts on coordinates without mass is what the body answers there. Their velocity is that of
/// the step: nothing but traces reads it.
double ExplicitDynamics::correct_layer(Motion& motion, double dt) const {
  double work = 0.0;
  for (const int dof : layer_.dofs()) {
    const std::size_t i = index(dof);
    const double moved = next_[i] - motion.q[i];
    motion.v[i] = moved / dt;
    work += 0.5 * (motion.force[i] + response_.force(dof)) * moved;
  }
  return work;
}

std::optional<Failed> ExplicitDynamics::step(Motion& motion, double time, double dt) {
  next_.resize(motion.q.size());
  update_all(motion.q.size(), [&](std::size_t, Range range) { predict(motion, dt, range); });
  for (const Prescribed& p : problem_.supports) {
    const double value = p.value(time + dt);
    if (!std::isfinite(value)) return not_finite(time + dt);
    next_[p.dof] = value;
  }
  if (!layer_.empty()) {
    const double end = time + dt;
    layer_.lead(motion, dt, next_);
    find_loads(end, next_);
    if (auto failed = layer_.settle(end, next_, motion.history, loads_, problem_.contact))
      return failed;
  }
  if (!problem_.model->evaluate(next_, motion.history, Model::Want::force, response_))
    return failed_newton({NewtonReport::End::inadmissible}, time + dt);
  layer_.complete(response_.force);
  find_loads(time + dt, next_);
  motion.external_work += correct_supports(motion, dt);
  if (!layer_.empty()) motion.external_work += correct_layer(motion, dt);
  update_all(motion.q.size(),
             [&](std::size_t k, Range range) { work_[k] = correct(motion, dt, range); });
  for (const double work : work_) motion.external_work += work;
  motion.q.swap(next_);
  motion.history.swap(response_.history);
  motion.dissipated += response_.dissipation;
  motion.stored = response_.stored;
  motion.step = dt;
  return std::nullopt;
}

std::optional<Failed> ExplicitDynamics::jump(Motion& motion, double time, const Vector& change) {
  view(motion.a) += inverse_mass_.cwiseProduct(change);
  if (layer_.empty()) return std::nullopt;
  if (auto failed = layer_.jump(time, motion, change, answer_)) return failed;
  view(motion.a) -= inverse_mass_.cwiseProduct(answer_);
  return std::nullopt;
}

void ExplicitDynamics::strike(Motion& motion, const Vector& impulse) {
  view(motion.v) += inverse_mass_.cwiseProduct(impulse);
}

/// Steps keep none of prescribed coordinates: they move from value to value.
void ExplicitDynamics::acceleration(const Motion& motion, double time, double step,
                                    const Vector&, Vector& out) const {
  out = view(motion.a);
  problem_.set_accelerations(time, step, out);
}

double ExplicitDynamics::kinetic(const Motion& motion) const {
  const auto v = view(motion.v), a = view(motion.a);
  const Vector& mass = problem_.model->lumped_mass();
  const double quarter = 0.25 * motion.step * motion.step;
  return 0.5 * (v.dot(mass.cwiseProduct(v)) - quarter * a.dot(mass.cwiseProduct(a)));
}

}  // namespace abut
