#include "coordinator/coupling/dirichlet_neumann.hpp"

#include <algorithm>
#include <cmath>

#include "base/assert.hpp"
#include "coordinator/coupling/exchange_parts.hpp"

namespace abut {

void DirichletNeumann::begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) {
  const Side& n = joint.neumann_side();
  iterate_ = {substeps_of(bodies, n, window), 1};
  const Waveform& trace = trace_of(bodies, n);
  ABUT_ASSERT(trace.width == 1);
  const std::size_t now = index_at_begin(trace, window.begin);
  keep_row(trace, trace.u, now, u_begin_);
  keep_row(trace, trace.v, now, v_begin_);
  keep_row(trace, trace.a, now, a_begin_);
  keep_row(trace, trace.f, now, f_begin_);
  // the guess holds the velocity after the impulse that this window begins with
  const PortResponse& port = port_of(bodies, n);
  if (port.recoil) {
    v_begin_[0] -=
        joint.normal_of(1 - joint.role.kinematic) * port.recoil->mobility * joint.contact.impulse;
  }
  scale_.step = iterate_.steps.step;
  scale_.velocity = joint.contact.closing_speed;
  scale_.roundoff = roundoff_of(largest(u_begin_), 0.0);
}

void DirichletNeumann::predict(Eigen::Ref<Eigen::VectorXd> x) const {
  const Eigen::Index size = iterate_.size();  // first guess as published: hold the old state
  for (Eigen::Index k = 0; k < size; ++k) {
    const std::size_t c = index(k % iterate_.width);
    x[k] = u_begin_[c];
    x[size + k] = v_begin_[c];
    x[2 * size + k] = a_begin_[c];
  }
}

void DirichletNeumann::impose(int side, const Eigen::Ref<const Eigen::VectorXd>& x,
                              const Joint& joint, Bodies& bodies) {
  const Side& here = joint.sides[side];
  if (side != joint.role.kinematic) {
    const Waveform& from = trace_of(bodies, joint.kinematic_side());
    Waveform& force = bodies.force(here);
    force.width = from.width;
    force.support = from.support;
    force.time = from.time;
    force.f = from.f;
    for (double& f : force.f) f = -f;
    // Substeps see a straight line from the force last exchanged, which was this side's own when
    // roles swap; the Dirichlet side's at that moment lacks another inertia.
    if (roles_swap_) std::ranges::copy(f_begin_, force.f.begin());
    return;
  }
  // Displacements are from each body's own reference: the reference gap closes the distance.
  const double shift = joint.offset(side);
  Waveform& motion = bodies.boundary(here).motion;
  motion.clear();
  motion.width = iterate_.width;
  motion.time.push_back(iterate_.steps.begin);
  for (int i = 1; i <= iterate_.steps.count; ++i) motion.time.push_back(iterate_.steps.time(i));
  const Eigen::Index size = iterate_.size();
  const auto fill = [&x, size](const std::vector<double>& first, int field,
                               std::vector<double>& to) {
    to = first;
    const auto values = x.segment(field * size, size);
    to.insert(to.end(), values.begin(), values.end());
  };
  fill(u_begin_, 0, motion.u);
  for (double& u : motion.u) u += shift;
  fill(v_begin_, 1, motion.v);
  fill(a_begin_, 2, motion.a);
}

void DirichletNeumann::image(const Eigen::Ref<const Eigen::VectorXd>&, const Joint& joint,
                             const Bodies& bodies, Eigen::Ref<Eigen::VectorXd> g) {
  const Waveform& trace = trace_of(bodies, joint.neumann_side());
  const Eigen::Index size = iterate_.size();
  for (int i = 1; i <= iterate_.steps.count; ++i) {
    const double time = iterate_.steps.time(i);
    const auto to = [this, &g, size, i](int field) {
      return std::span<double>(&g[field * size + iterate_.at(i)], index(iterate_.width));
    };
    trace.interpolate(trace.u, time, to(0));
    trace.interpolate(trace.v, time, to(1));
    trace.interpolate(trace.a, time, to(2));
  }
  // sides that were tied from the start have no velocity of a first touch
  if (joint.contact.closing_speed == 0.0) {
    scale_.velocity = std::max(largest(v_begin_), g.segment(size, size).lpNorm<Eigen::Infinity>());
  }
}

FieldResiduals DirichletNeumann::measure(const Eigen::Ref<const Eigen::VectorXd>& x,
                                         const Eigen::Ref<const Eigen::VectorXd>& g) const {
  const Eigen::Index n = iterate_.size();
  auto mismatch = [&x, &g, n](int field) {
    return (g.segment(field * n, n) - x.segment(field * n, n)).lpNorm<Eigen::Infinity>();
  };
  FieldResiduals r;
  r.displacement = scaled(mismatch(0), scale_.velocity * scale_.step, scale_.roundoff);
  r.velocity = scaled(mismatch(1), scale_.velocity, scale_.roundoff / scale_.step);
  r.acceleration = scaled(mismatch(2), scale_.velocity / scale_.step,
                          scale_.roundoff / (scale_.step * scale_.step));
  return r;
}

void DirichletNeumann::scales(Eigen::Ref<Eigen::VectorXd> s) const {
  const Eigen::Index n = iterate_.size();
  const double v = scale_.velocity > 0.0 ? scale_.velocity : 1.0;
  s.segment(0, n).setConstant(1.0 / (v * scale_.step));
  s.segment(n, n).setConstant(1.0 / v);
  s.segment(2 * n, n).setConstant(scale_.step / v);
}

/// All of it is read from the latest responses when a window begins.
void DirichletNeumann::state(Archive&) {}

}  // namespace abut
