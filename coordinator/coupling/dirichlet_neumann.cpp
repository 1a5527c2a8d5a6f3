#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.hpp"
#include "coordinator/coupling/transmission.hpp"

namespace abut {

void DirichletNeumann::begin(const TimeWindow& window, const Interface& interface, Bodies& bodies) {
  const Side& n = interface.neumann_side();
  grid_ = TimeGrid(window.begin, window.end, bodies.describe(n.body).step);
  const Waveform& trace = trace_of(bodies, n);
  const std::size_t now = index_at_begin(trace, window.begin);
  u_begin_ = trace.u[now];
  v_begin_ = trace.v[now];
  a_begin_ = trace.a[now];
  f_begin_ = trace.f[now];
  // the guess holds the velocity after the impulse that this window begins with
  const PortResponse& port = bodies.response(n.body).ports[index(n.port)];
  if (port.recoil) {
    v_begin_ -=
        interface.normal_of(1 - interface.kinematic) * port.recoil->mobility * interface.impulse;
  }
  scale_.step = grid_.step;
  scale_.velocity = interface.closing_speed;
  scale_.roundoff = 64.0 * std::numeric_limits<double>::epsilon() * std::abs(u_begin_);
}

void DirichletNeumann::predict(Eigen::Ref<Eigen::VectorXd> x) const {
  const int n = grid_.count;  // first guess as published: hold the old state
  x.segment(0, n).setConstant(u_begin_);
  x.segment(n, n).setConstant(v_begin_);
  x.segment(2 * n, n).setConstant(a_begin_);
}

void DirichletNeumann::impose(int side, const Eigen::Ref<const Eigen::VectorXd>& x,
                              const Interface& interface, Bodies& bodies) {
  const Side& here = interface.sides[index(side)];
  BoundaryData& data = bodies.request(here.body).boundary[index(here.port)];
  if (side != interface.kinematic) {
    const Waveform& from = trace_of(bodies, interface.kinematic_side());
    data.force.support = from.support;
    data.force.time = from.time;
    data.force.f = from.f;
    for (double& f : data.force.f) f = -f;
    // Substeps see a straight line from the force last exchanged, which was this side's own when
    // roles swap; the Dirichlet side's at that moment lacks another inertia.
    if (roles_swap_) data.force.f.front() = f_begin_;
    return;
  }
  const int n = grid_.count;
  // Displacements are from each body's own reference: the reference gap closes the distance.
  const double shift = interface.offset(side);
  Waveform& motion = data.motion;
  motion.clear();
  motion.time.push_back(grid_.begin);
  motion.u.push_back(u_begin_ + shift);
  motion.v.push_back(v_begin_);
  motion.a.push_back(a_begin_);
  for (int i = 0; i < n; ++i) {
    motion.time.push_back(grid_.time(i + 1));
    motion.u.push_back(x[i] + shift);
    motion.v.push_back(x[n + i]);
    motion.a.push_back(x[2 * n + i]);
  }
}

void DirichletNeumann::image(const Eigen::Ref<const Eigen::VectorXd>&, const Interface& interface,
                             const Bodies& bodies, Eigen::Ref<Eigen::VectorXd> g) {
  const Waveform& trace = trace_of(bodies, interface.neumann_side());
  const int n = grid_.count;
  for (int i = 0; i < n; ++i) {
    const double time = grid_.time(i + 1);
    trace.interpolate(trace.u, time, {&g[i], 1});
    trace.interpolate(trace.v, time, {&g[n + i], 1});
    trace.interpolate(trace.a, time, {&g[2 * n + i], 1});
  }
  // sides that were tied from the start have no velocity of a first touch
  if (interface.closing_speed == 0.0) {
    scale_.velocity = std::max(std::abs(v_begin_), g.segment(n, n).lpNorm<Eigen::Infinity>());
  }
}

FieldResiduals DirichletNeumann::measure(const Eigen::Ref<const Eigen::VectorXd>& x,
                                         const Eigen::Ref<const Eigen::VectorXd>& g) const {
  const int n = grid_.count;
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
  const int n = grid_.count;
  const double v = scale_.velocity > 0.0 ? scale_.velocity : 1.0;
  s.segment(0, n).setConstant(1.0 / (v * scale_.step));
  s.segment(n, n).setConstant(1.0 / v);
  s.segment(2 * n, n).setConstant(scale_.step / v);
}

}  // namespace abut
