#include "coordinator/coupling/compare/robin.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/assert.hpp"
#include "coordinator/coupling/exchange_parts.hpp"

namespace abut {

namespace {

/// Velocity under a constant unit force, read off where it no longer changes: before that the probe
/// sees the contact node and not the wave behind it.
constexpr int shortest_probe = 32, longest_probe = 2048;
constexpr double settled = 0.03;

double characteristic_impedance(Bodies& bodies, const Side& side, double step) {
  double last = 0.0;
  for (int n = shortest_probe; n <= longest_probe; n *= 2) {
    const std::vector<double>& c = bodies.kernel(side.body, side.port, n).displacement;
    const double moved = std::accumulate(c.begin() + n / 2, c.begin() + n, 0.0);
    const double now = 0.5 * n * step / moved;
    if (std::abs(now - last) <= settled * now) return now;
    last = now;
  }
  return last;
}

}  // namespace

std::array<int, 2> Robin::iterated() const { return {kinematic_, 1 - kinematic_}; }

int Robin::values() const {
  int count = 0;
  for (int k = 0; k < parts(); ++k) count += partner(iterated()[k]).grid.count;
  return count;
}

void Robin::find_impedances(const Joint& joint, Bodies& bodies) {
  for (std::size_t s : {0u, 1u}) {
    const Side& other = joint.sides[1 - s];
    const Substeps& grid = sides_[1 - s].grid;
    double z = given_;
    if (rule_ == Rule::matched) z = characteristic_impedance(bodies, other, grid.step);
    if (rule_ == Rule::kernel)
      z = grid.step / bodies.kernel(other.body, other.port, 1).displacement.front();
    sides_[s].impedance = z;
  }
  impedance_sum_ = sides_[0].impedance + sides_[1].impedance;
}

void Robin::begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) {
  kinematic_ = joint.role.kinematic;
  double compliance = 0.0, moved = joint.line.reference_gap;
  double u[2];
  for (std::size_t s : {0u, 1u}) {
    const Side& here = joint.sides[s];
    const Waveform& trace = trace_of(bodies, here);
    ABUT_ASSERT(trace.width == 1);
    const std::size_t now = index_at_begin(trace, window.begin);
    const double n = joint.normal_of(static_cast<int>(s));
    Begin& side = sides_[s];
    side.grid = substeps_of(bodies, here, window);
    side.support = trace.support;
    u[s] = trace.u[now];
    side.v = trace.v[now] * n;
    side.force = trace.f[now] * -n;
    moved = std::max(moved, std::abs(u[s]));
    compliance += bodies.kernel(here.body, here.port, 1).displacement.front();
  }
  overlap_ = -joint.gap(u[0], u[1]);
  if (impedance_sum_ == 0.0) find_impedances(joint, bodies);
  scale_.step = std::max(sides_[0].grid.step, sides_[1].grid.step);
  scale_.velocity = reference_velocity(joint, compliance, scale_.step);
  scale_.force = joint.contact.force_scale;
  scale_.roundoff = roundoff_of(moved, 0.0);
}

void Robin::predict(Eigen::Ref<Eigen::VectorXd> x) const {
  Eigen::Index at = 0;
  for (int k = 0; k < parts(); ++k) {
    const int side = iterated()[k];
    const Begin& here = sides_[side];
    const Begin& other = partner(side);
    const Substeps& steps = other.grid;
    const bool known =
        here.incoming_begin == steps.begin && static_cast<int>(here.incoming.size()) >= steps.count;
    for (int i = 0; i < steps.count; ++i) {
      const double close = i == 0 ? overlap_ / (steps.time(1) - steps.time(0)) : 0.0;
      x[at++] = known ? here.incoming[i] : other.force + here.impedance * (other.v + close);
    }
  }
}

void Robin::outgoing(int side, const Joint& joint, const Bodies& bodies,
                     Eigen::Ref<Eigen::VectorXd> q) const {
  const double n = joint.normal_of(1 - side);
  const double z = sides_[side].impedance;
  const Waveform& trace = trace_of(bodies, joint.sides[1 - side]);
  for (std::size_t i = 1; i < trace.size(); ++i) {
    double moved = n * (trace.u[i] - trace.u[i - 1]);
    if (i == 1) moved += overlap_;
    q[static_cast<Eigen::Index>(i) - 1] =
        -n * trace.f[i] + z * moved / (trace.time[i] - trace.time[i - 1]);
  }
}

void Robin::impose(int side, const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
                   Bodies& bodies) {
  Begin& here = sides_[side];
  const Begin& other = partner(side);
  const Substeps& steps = other.grid;
  const int size = steps.count;
  Eigen::VectorXd q(size);
  if (side == kinematic_) {
    q = x.head(size);
  } else if (parallel_) {
    q = x.tail(size);
  } else {
    outgoing(side, joint, bodies, q);
  }
  here.incoming.assign(q.begin(), q.end());
  here.incoming_begin = steps.begin;
  const Side& port = joint.sides[side];
  const double inward = -joint.normal_of(side);
  Waveform& force = bodies.force(port);
  lay_times(steps, 1, force);
  force.support = other.support;
  force.f.push_back(inward * (other.force + here.impedance * other.v));
  for (double value : q) force.f.push_back(inward * value);
  bodies.boundary(port).impedance = {here.impedance, joint.tied()};
}

void Robin::image(const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
                  const Bodies& bodies, Eigen::Ref<Eigen::VectorXd> g) {
  const int first = partner(kinematic_).grid.count;
  outgoing(kinematic_, joint, bodies, g.head(first));
  if (parallel_) outgoing(1 - kinematic_, joint, bodies, g.tail(x.size() - first));
  for (double f : trace_of(bodies, joint.kinematic_side()).f)
    scale_.force = std::max(scale_.force, std::abs(f));
  scale_.velocity = std::max(scale_.velocity, scale_.force / impedance_sum_ * 1.0e-3);
  scale_.force = std::max(scale_.force, scale_.velocity * impedance_sum_ * 1.0e-3);
}

FieldResiduals Robin::measure(const Eigen::Ref<const Eigen::VectorXd>& x,
                              const Eigen::Ref<const Eigen::VectorXd>& g) const {
  // A difference in q is the sum of the impedances times the rate at which the sides still overlap.
  FieldResiduals r;
  Eigen::Index at = 0;
  for (int k = 0; k < parts(); ++k) {
    const Substeps& steps = partner(iterated()[k]).grid;
    double left = 0.0;
    for (int i = 1; i <= steps.count; ++i, ++at) {
      const double difference = g[at] - x[at];
      left += difference / impedance_sum_ * (steps.time(i) - steps.time(i - 1));
      r.displacement =
          std::max(r.displacement, scaled(left, scale_.velocity * scale_.step, scale_.roundoff));
      r.force = std::max(r.force, scaled(0.5 * difference, scale_.force,
                                         scale_.roundoff / scale_.step * impedance_sum_));
    }
  }
  return r;
}

void Robin::scales(Eigen::Ref<Eigen::VectorXd> s) const {
  const double unit = impedance_sum_ * scale_.velocity;
  s.setConstant(unit > 0.0 ? 1.0 / unit : 1.0);
}

void Robin::state(Archive& archive) {
  archive.field("impedance_sum", impedance_sum_);
  for (Begin& side : sides_) archive.field("impedance", side.impedance);
}

}  // namespace abut
