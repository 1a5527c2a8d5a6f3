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
class CoarseForces {
 public:
  CoarseForces(const Interface& interface, const Bodies& bodies)
      : own_(trace_of(bodies, interface.kinematic_side())),
        other_(trace_of(bodies, interface.neumann_side())),
        inward_(-interface.normal_of(interface.kinematic)),
        step_support_(own_.support == ForceSupport::step) {
    const double own_step = bodies.describe(interface.kinematic_side().body).step;
    const double other_step = bodies.describe(interface.neumann_side().body).step;
    other_is_coarser_ = other_step > own_step;
    coarse_step_ = std::max(own_step, other_step);
  }

  std::size_t size() const { return grid().size(); }
  ForceSample operator[](std::size_t i) const {
    const std::vector<double>& t = grid();
    double at = t[i];  // a kick acts at its substep's begin
    if (step_support_) at = i > 0 ? t[i - 1] : at - coarse_step_;
    double force = own_.f[i > 0 && other_is_coarser_ ? 0 : i];
    if (i > 0 && other_is_coarser_) {
      const double from = step_support_ ? t[i - 1] : 0.5 * (t[i - 1] + t[i]);
      const double to = step_support_ || i + 1 == t.size() ? t[i] : 0.5 * (t[i] + t[i + 1]);
      own_.impulse(from, to, {&force, 1});
      force /= to - from;
    }
    return {at, inward_ * force, t[i]};
  }

 private:
  const std::vector<double>& grid() const { return other_is_coarser_ ? other_.time : own_.time; }

  const Waveform& own_;
  const Waveform& other_;
  double inward_;
  bool step_support_;
  bool other_is_coarser_ = false;
  double coarse_step_ = 0.0;
};

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
  const CoarseForces samples(interface, bodies);
  ForceSample last = samples[0];
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const ForceSample now = samples[i];
    if (now.force >= floor) {
      last = now;
      continue;
    }
    const double drop = last.force - now.force;
    double crossing = last.state;
    if (last.force > 0.0 && drop > 0.0 && now.time > last.time) {
      crossing = last.time + (now.time - last.time) * std::min(1.0, last.force / drop);
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

double closing_impulse(const Interface& interface, const Bodies& bodies) {
  double approach = 0.0;  // sum of w0
  double mobility = 0.0;  // sum of G0
  for (const Side& side : interface.sides) {
    if (std::isinf(bodies.describe(side.body).mass)) continue;
    const PortResponse& port =
        bodies.response(side.body).ports[static_cast<std::size_t>(side.port)];
    if (!port.rebound) return 0.0;
    approach += port.rebound->nodal_velocity;
    mobility += port.rebound->node_mobility;
  }
  return mobility > 0.0 ? approach / mobility : 0.0;
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
