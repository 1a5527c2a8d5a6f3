#include "coordinator/coupling/dirichlet_neumann.hpp"

#include <algorithm>
#include <cmath>

#include "base/assert.hpp"
#include "coordinator/coupling/exchange_parts.hpp"

namespace abut {

void DirichletNeumann::begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) {
  const Side& n = joint.neumann_side();
  grid_ = substeps_of(bodies, n, window);
  const Waveform& trace = trace_of(bodies, n);
  ABUT_ASSERT(trace.width == 1);
  const std::size_t now = index_at_begin(trace, window.begin);
  u_begin_ = trace.u[now];
  v_begin_ = trace.v[now];
  a_begin_ = trace.a[now];
  f_begin_ = trace.f[now];
  // the guess holds the velocity after the impulse that this window begins with
  const PortResponse& port = port_of(bodies, n);
  if (port.recoil) {
    v_begin_ -=
        joint.normal_of(1 - joint.role.kinematic) * port.recoil->mobility * joint.contact.impulse;
  }
  scale_.step = grid_.step;
  scale_.velocity = joint.contact.closing_speed;
  scale_.roundoff = roundoff_of(u_begin_, 0.0);
}

void DirichletNeumann::predict(Eigen::Ref<Eigen::VectorXd> x) const {
  x.head(grid_.count).setConstant(u_begin_);  // as published: hold the old state
  x.segment(grid_.count, grid_.count).setConstant(v_begin_);
  x.tail(grid_.count).setConstant(a_begin_);
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
    if (roles_swap_) force.f.front() = f_begin_;
    return;
  }
  // Displacements are from each body's own reference: the reference gap closes the distance.
  const double shift = joint.offset(side);
  Waveform& motion = bodies.boundary(here).motion;
  lay_times(grid_, 1, motion);
  const auto fill = [&](double first, int field, std::vector<double>& to) {
    to.push_back(first);
    const auto values = x.segment(field * grid_.count, grid_.count);
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
  const int size = grid_.count;
  for (int i = 1; i <= size; ++i) {
    g[i - 1] = value_at(trace, trace.u, grid_.time(i));
    g[size + i - 1] = value_at(trace, trace.v, grid_.time(i));
    g[2 * size + i - 1] = value_at(trace, trace.a, grid_.time(i));
  }
  // sides that were tied from the start have no velocity of a first touch
  if (joint.contact.closing_speed == 0.0) {
    scale_.velocity = std::max(std::abs(v_begin_), g.segment(size, size).lpNorm<Eigen::Infinity>());
  }
}

FieldResiduals DirichletNeumann::measure(const Eigen::Ref<const Eigen::VectorXd>& x,
                                         const Eigen::Ref<const Eigen::VectorXd>& g) const {
  const Eigen::Index n = grid_.count;
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
  const Eigen::Index n = grid_.count;
  const double v = scale_.velocity > 0.0 ? scale_.velocity : 1.0;
  s.segment(0, n).setConstant(1.0 / (v * scale_.step));
  s.segment(n, n).setConstant(1.0 / v);
  s.segment(2 * n, n).setConstant(scale_.step / v);
}

/// All of it is read from the latest responses when a window begins.
void DirichletNeumann::state(Archive&) {}

}  // namespace abut
