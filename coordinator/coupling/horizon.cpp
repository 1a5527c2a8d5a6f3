#include "coordinator/coupling/horizon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "coordinator/coupling/watch.hpp"

namespace abut {

namespace {
/// Share of the estimated time to contact that is flown at once; the rest is for what the bound
/// does not know.
constexpr double horizon_margin = 0.95;
}  // namespace

double free_flight_horizon(std::span<Joint> joints, const Bodies& bodies) {
  double horizon = std::numeric_limits<double>::infinity();
  for (Joint& joint : joints) {
    if (joint.closed()) return 0.0;
    const auto [gap, v] = joint.watch->approach(joint, bodies);
    if (gap <= 0.0) return 0.0;
    double a = 0.0;
    for (const Side& side : joint.sides) a += port_of(bodies, side).acceleration_bound;
    const double root = std::sqrt(std::max(0.0, v * v + 2.0 * a * gap));
    if (v + root <= 0.0) continue;
    horizon = std::min(horizon, horizon_margin * 2.0 * gap / (v + root));
  }
  return horizon;
}

bool stayed_apart(std::span<const Joint> joints, const Bodies& bodies, double length) {
  return std::ranges::all_of(joints, [&bodies, length](const Joint& joint) {
    return joint.watch->stayed_apart(joint, bodies, length);
  });
}

}  // namespace abut
