#include "coordinator/coupling/horizon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "coordinator/coupling/nearness.hpp"

namespace abut {

namespace {
/// Share of the estimated time to contact that is flown at once; the rest is for what the bound
/// does not know.
constexpr double margin = 0.95;
}  // namespace

double free_flight_horizon(std::span<Joint> joints, const Bodies& bodies) {
  double horizon = std::numeric_limits<double>::infinity();
  for (Joint& joint : joints) {
    if (joint.closed()) return 0.0;
    if (joint.surfaces) measure_approach(joint, bodies);
    const PortResponse& p0 = port_of(bodies, joint.sides[0]);
    const PortResponse& p1 = port_of(bodies, joint.sides[1]);
    const double gap =
        joint.surfaces ? joint.approach.apart : joint.gap(p0.trace.u.back(), p1.trace.u.back());
    if (gap <= 0.0) return 0.0;
    const double v = joint.surfaces ? joint.approach.speed : p0.speed_bound + p1.speed_bound;
    const double a = p0.acceleration_bound + p1.acceleration_bound;
    const double root = std::sqrt(std::max(0.0, v * v + 2.0 * a * gap));
    if (v + root <= 0.0) continue;
    horizon = std::min(horizon, margin * 2.0 * gap / (v + root));
  }
  return horizon;
}

bool stayed_apart(std::span<const Joint> joints, const Bodies& bodies, double length) {
  return std::ranges::all_of(joints, [&bodies, length](const Joint& joint) {
    if (joint.surfaces) return kept_apart(joint, bodies, length);
    const PortResponse& p0 = port_of(bodies, joint.sides[0]);
    const PortResponse& p1 = port_of(bodies, joint.sides[1]);
    const bool right = joint.normal[0] > 0.0;  // side 0 looks to the right
    const std::vector<double>& left_side = right ? p0.upper : p1.upper;
    const std::vector<double>& right_side = right ? p1.lower : p0.lower;
    for (std::size_t part = 0; part < std::min(left_side.size(), right_side.size()); ++part) {
      if (right_side[part] <= left_side[part]) return false;
    }
    return true;
  });
}

}  // namespace abut
