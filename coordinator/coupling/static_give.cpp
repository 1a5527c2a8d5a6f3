#include "coordinator/coupling/static_give.hpp"

#include <cmath>
#include <vector>

namespace abut {

/// What stabilises a body lets it go a hundred times as far as it is deformed, and leaves it there
/// when the force has gone: a step later the deformation has gone alone.
double static_give(const Side& side, Bodies& bodies) {
  const Description& body = bodies.describe(side.body);
  if (!body.quasi_static || !body.can.kernel) return 0.0;
  const std::vector<double>& moved = bodies.kernel(side.body, side.port, 2).displacement;
  return std::abs(moved[0] - moved[1]) / bodies.port(side).geometry.count();
}

}  // namespace abut
