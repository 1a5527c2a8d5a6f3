#include "coordinator/coupling/contact.hpp"

#include <algorithm>
#include <cmath>

namespace abut {

namespace {

double displacement_at(const Waveform& trace, double time) {
  double u = 0.0;
  trace.interpolate(trace.u, time, {&u, 1});
  return u;
}

struct ForceSample {
  double time = 0.0;   // [s] at which the force acts
  double force = 0.0;  // [N] compressive
  double state = 0.0;  // [s] end of the substep
};

/// Contact force at the substeps of the coarser side, the one known at the window's begin first.
std::vector<ForceSample> coarse_forces(const Interface& interface, const Bodies& bodies) {
  const Side& k = interface.kinematic_side();
  const Side& n = interface.neumann_side();
  const Waveform& own = trace_of(bodies, k);
  const double inward = -interface.normal_of(interface.kinematic);
  const bool step_support = own.support == ForceSupport::step;
  std::vector<ForceSample> samples;
  if (bodies.describe(n.body).step > bodies.describe(k.body).step) {
    const std::vector<double>& grid = trace_of(bodies, n).time;
    const double known = step_support ? grid.front() - bodies.describe(n.body).step : grid.front();
    samples.push_back({known, inward * own.f.front(), grid.front()});
    for (std::size_t i = 1; i < grid.size(); ++i) {
      const double from = step_support ? grid[i - 1] : 0.5 * (grid[i - 1] + grid[i]);
      const double to =
          step_support || i + 1 == grid.size() ? grid[i] : 0.5 * (grid[i] + grid[i + 1]);
      double impulse = 0.0;
      own.impulse(from, to, {&impulse, 1});
      samples.push_back(
          {step_support ? grid[i - 1] : grid[i], inward * impulse / (to - from), grid[i]});
    }
    return samples;
  }
  for (std::size_t i = 0; i < own.size(); ++i) {
    double at = own.time[i];
    if (step_support) at = i > 0 ? own.time[i - 1] : at - bodies.describe(k.body).step;
    samples.push_back({at, inward * own.f[i], own.time[i]});
  }
  return samples;
}

}  // namespace

std::optional<Closing> overlap_criterion(const Interface& interface, const Bodies& bodies) {
  const Waveform& t0 = trace_of(bodies, interface.sides[0]);
  const Waveform& t1 = trace_of(bodies, interface.sides[1]);
  const Waveform& finer = t0.size() >= t1.size() ? t0 : t1;
  const double coarse_step = std::max(bodies.describe(interface.sides[0].body).step,
                                      bodies.describe(interface.sides[1].body).step);
  const double earliest = interface.opened_at + coarse_step;
  double before = interface.gap(t0.u.front(), t1.u.front());
  for (std::size_t i = 1; i < finer.size(); ++i) {
    const double time = finer.time[i];
    const double gap = interface.gap(displacement_at(t0, time), displacement_at(t1, time));
    // a gap that grows is a release, however little it overlaps
    if (gap <= 0.0 && gap < before && time > earliest) {
      const double length = time - finer.time[i - 1];
      const double share = before <= 0.0 ? 0.0 : before / (before - gap);
      return Closing{finer.time[i - 1] + share * length, (before - gap) / length};
    }
    before = gap;
  }
  return std::nullopt;
}

std::optional<Opening> compression_criterion(const Interface& interface, const Bodies& bodies,
                                             double floor) {
  const std::vector<ForceSample> samples = coarse_forces(interface, bodies);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (samples[i].force >= floor) continue;
    const ForceSample& last = samples[i - 1];
    const double drop = last.force - samples[i].force;
    double crossing = last.state;
    if (last.force > 0.0 && drop > 0.0 && samples[i].time > last.time) {
      crossing = last.time + (samples[i].time - last.time) * std::min(1.0, last.force / drop);
    }
    return Opening{crossing, last.state};
  }
  return std::nullopt;
}

double peak_force(const Interface& interface, const Bodies& bodies) {
  double peak = 0.0;
  for (double f : trace_of(bodies, interface.kinematic_side()).f)
    peak = std::max(peak, std::abs(f));
  return peak;
}

double release_impulse(const Interface& interface, const Bodies& bodies) {
  double approach = 0.0;  // sum of w0* - w1*
  double mobility = 0.0;  // sum of G0 - G1
  double node_mobility = 0.0;
  double mean_velocity = 0.0;
  double captured = 0.0;
  for (const Side& side : interface.sides) {
    if (std::isinf(bodies.describe(side.body).mass)) continue;
    const PortResponse& port =
        bodies.response(side.body).ports[static_cast<std::size_t>(side.port)];
    if (!port.rebound) return 0.0;
    const Rebound& r = *port.rebound;
    approach += r.node_velocity - r.inner_velocity;
    mobility += r.node_mobility - r.inner_mobility;
    node_mobility += r.node_mobility;
    mean_velocity += r.nodal_velocity;  // mean of the half-step velocities around it
    captured += r.captured;
  }
  if (mobility <= 0.0 || captured <= 0.0) return 0.0;
  const double discriminant = mean_velocity * mean_velocity + 2.0 * node_mobility * captured;
  const double passive = (mean_velocity + std::sqrt(discriminant)) / node_mobility;
  return std::clamp(approach / mobility, 0.0, std::max(0.0, passive));
}

}  // namespace abut
