#include "coordinator/coupling/horizon.hpp"
#include "base/index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace abut {

namespace {
/// Share of the estimated time to contact that is flown at once; the rest is for what the bound
/// does not know.
constexpr double margin = 0.95;

const PortResponse& port_of(const Bodies& bodies, const Side& side) {
  return bodies.response(side.body).ports[index(side.port)];
}
}  // namespace

double free_flight_horizon(std::span<const Interface> interfaces, const Bodies& bodies) {
  double horizon = std::numeric_limits<double>::infinity();
  for (const Interface& interface : interfaces) {
    if (interface.closed) return 0.0;
    const PortResponse& p0 = port_of(bodies, interface.sides[0]);
    const PortResponse& p1 = port_of(bodies, interface.sides[1]);
    const double gap = interface.gap(p0.trace.u.back(), p1.trace.u.back());
    if (gap <= 0.0) return 0.0;
    const double v = p0.approach_bound + p1.approach_bound;
    const double a = p0.approach_acceleration + p1.approach_acceleration;
    const double root = std::sqrt(std::max(0.0, v * v + 2.0 * a * gap));
    if (v + root <= 0.0) continue;
    horizon = std::min(horizon, margin * 2.0 * gap / (v + root));
  }
  return horizon;
}

bool stayed_apart(std::span<const Interface> interfaces, const Bodies& bodies) {
  return std::all_of(interfaces.begin(), interfaces.end(), [&bodies](const Interface& interface) {
    const PortResponse& p0 = port_of(bodies, interface.sides[0]);
    const PortResponse& p1 = port_of(bodies, interface.sides[1]);
    const bool right = interface.normal[0] > 0.0;  // side 0 looks to the right
    const std::vector<double>& outer0 = right ? p0.upper : p0.lower;
    const std::vector<double>& outer1 = right ? p1.lower : p1.upper;
    for (std::size_t part = 0; part < std::min(outer0.size(), outer1.size()); ++part) {
      if (interface.gap(outer0[part], outer1[part]) <= 0.0) return false;
    }
    return true;
  });
}

}  // namespace abut
