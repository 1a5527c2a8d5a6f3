#include "coordinator/coupling/robin.hpp"
#include "base/index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

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
  for (int k = 0; k < parts(); ++k) count += partner(iterated()[index(k)]).grid.count;
  return count;
}

void Robin::find_impedances(const Interface& interface, Bodies& bodies) {
  for (std::size_t s : {0u, 1u}) {
    const Side& other = interface.sides[1 - s];
    const TimeGrid& grid = sides_[1 - s].grid;
    double z = given_;
    if (rule_ == Rule::matched) z = characteristic_impedance(bodies, other, grid.step);
    if (rule_ == Rule::kernel)
      z = grid.step / bodies.kernel(other.body, other.port, 1).displacement.front();
    sides_[s].impedance = z;
  }
  impedance_sum_ = sides_[0].impedance + sides_[1].impedance;
}

void Robin::begin(const TimeWindow& window, const Interface& interface, Bodies& bodies) {
  kinematic_ = interface.kinematic;
  double u[2] = {0.0, 0.0};
  double compliance = 0.0;
  for (std::size_t s : {0u, 1u}) {
    const Side& here = interface.sides[s];
    const Waveform& trace = trace_of(bodies, here);
    const std::size_t now = index_at_begin(trace, window.begin);
    const double n = interface.normal_of(static_cast<int>(s));
    Begin& side = sides_[s];
    side.grid = TimeGrid(window.begin, window.end, bodies.describe(here.body).step);
    side.support = trace.support;
    u[s] = trace.u[now];
    side.u = n * trace.u[now];
    side.v = n * trace.v[now];
    side.force = -n * trace.f[now];
    compliance += bodies.kernel(here.body, here.port, 1).displacement.front();
  }
  overlap_ = -interface.gap(u[0], u[1]);
  if (impedance_sum_ == 0.0) find_impedances(interface, bodies);
  scale_.step = std::max(sides_[0].grid.step, sides_[1].grid.step);
  scale_.velocity =
      std::max(interface.closing_speed, interface.force_scale * compliance / scale_.step);
  scale_.force = interface.force_scale;
  scale_.roundoff = 64.0 * std::numeric_limits<double>::epsilon() *
                    std::max({std::abs(u[0]), std::abs(u[1]), interface.reference_gap});
}

void Robin::predict(Eigen::Ref<Eigen::VectorXd> x) const {
  Eigen::Index at = 0;
  for (int k = 0; k < parts(); ++k) {
    const int side = iterated()[index(k)];
    const Begin& here = sides_[index(side)];
    const Begin& other = partner(side);
    const bool known = here.incoming_begin == other.grid.begin &&
                       static_cast<int>(here.incoming.size()) >= other.grid.count;
    for (int i = 0; i < other.grid.count; ++i) {
      const double length = other.grid.time(i + 1) - other.grid.time(i);
      const double close = i == 0 ? overlap_ / length : 0.0;
      x[at++] = known ? here.incoming[index(i)] : other.force + here.impedance * (other.v + close);
    }
  }
}

void Robin::outgoing(int side, const Interface& interface, const Bodies& bodies,
                     Eigen::Ref<Eigen::VectorXd> q) const {
  const double n = interface.normal_of(1 - side);
  const double z = sides_[index(side)].impedance;
  const Waveform& trace = trace_of(bodies, interface.sides[index(1 - side)]);
  for (std::size_t i = 1; i < trace.size(); ++i) {
    const double length = trace.time[i] - trace.time[i - 1];
    double moved = n * (trace.u[i] - trace.u[i - 1]);
    if (i == 1) moved += overlap_;
    q[static_cast<Eigen::Index>(i) - 1] = -n * trace.f[i] + z * moved / length;
  }
}

void Robin::impose(int side, const Eigen::Ref<const Eigen::VectorXd>& x, const Interface& interface,
                   Bodies& bodies) {
  Begin& here = sides_[index(side)];
  const Begin& other = partner(side);
  const int count = other.grid.count;
  Eigen::VectorXd q(count);
  if (side == kinematic_) {
    q = x.head(count);
  } else if (parallel_) {
    q = x.tail(count);
  } else {
    outgoing(side, interface, bodies, q);
  }
  here.incoming.assign(q.begin(), q.end());
  here.incoming_begin = other.grid.begin;
  const Side& port = interface.sides[index(side)];
  BoundaryData& data = bodies.request(port.body).boundary[index(port.port)];
  const double inward = -interface.normal_of(side);
  data.force.clear();
  data.force.support = other.support;
  data.force.time.push_back(other.grid.begin);
  data.force.f.push_back(inward * (other.force + here.impedance * other.v));
  for (int i = 1; i <= count; ++i) {
    data.force.time.push_back(other.grid.time(i));
    data.force.f.push_back(inward * q[i - 1]);
  }
  data.impedance = {here.impedance, interface.bilateral};
}

void Robin::image(const Eigen::Ref<const Eigen::VectorXd>& x, const Interface& interface,
                  const Bodies& bodies, Eigen::Ref<Eigen::VectorXd> g) {
  const Eigen::Index first = partner(kinematic_).grid.count;
  outgoing(kinematic_, interface, bodies, g.head(first));
  if (parallel_) outgoing(1 - kinematic_, interface, bodies, g.tail(x.size() - first));
  for (double f : trace_of(bodies, interface.kinematic_side()).f)
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
    const TimeGrid& grid = partner(iterated()[index(k)]).grid;
    double overlap = 0.0;
    for (int i = 0; i < grid.count; ++i, ++at) {
      const double difference = g[at] - x[at];
      overlap += difference / impedance_sum_ * (grid.time(i + 1) - grid.time(i));
      r.displacement =
          std::max(r.displacement, scaled(overlap, scale_.velocity * scale_.step, scale_.roundoff));
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

}  // namespace abut
