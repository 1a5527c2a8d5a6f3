#include "coordinator/coupling/nearness.hpp"

#include <algorithm>
#include <cmath>

namespace abut {

double distance(const Joint& joint, const Bodies& bodies) {
  const PortResponse& a = port_of(bodies, joint.sides[0]);
  const PortResponse& b = port_of(bodies, joint.sides[1]);
  const std::size_t dim = index(bodies.port(joint.sides[0]).geometry.dim);
  const std::size_t last_a = a.lower.size() - dim, last_b = b.lower.size() - dim;
  double square = 0.0;
  for (std::size_t i = 0; i < dim; ++i) {
    const double apart = std::max(a.lower[last_a + i] - b.upper[last_b + i],
                                  b.lower[last_b + i] - a.upper[last_a + i]);
    if (apart > 0.0) square += apart * apart;
  }
  return std::max(0.0, std::sqrt(square) - joint.margin);
}

bool boxes_apart(const Joint& joint, const Bodies& bodies) {
  const PortResponse& a = port_of(bodies, joint.sides[0]);
  const PortResponse& b = port_of(bodies, joint.sides[1]);
  const std::size_t dim = index(bodies.port(joint.sides[0]).geometry.dim);
  const std::size_t values = std::min(a.lower.size(), b.lower.size());
  for (std::size_t part = 0; part < values; part += dim) {
    bool apart = false;
    for (std::size_t i = part; i < part + dim; ++i)
      apart =
          apart || a.lower[i] > b.upper[i] + joint.margin || b.lower[i] > a.upper[i] + joint.margin;
    if (!apart) return false;
  }
  return true;
}

double closing_bound(const Joint& joint, const Bodies& bodies) {
  return port_of(bodies, joint.sides[0]).speed_bound + port_of(bodies, joint.sides[1]).speed_bound;
}

}  // namespace abut
