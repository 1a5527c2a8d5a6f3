#include "coordinator/coupling/roles.hpp"

#include <cmath>
#include <limits>
#include <numeric>

#include "base/index.hpp"
#include "coordinator/coupling/port_jacobian.hpp"

namespace abut {

namespace {
/// Compliances within this factor count as similar: the mesh decides.
constexpr double similar = 3.0;
}  // namespace

int kinematic_side(const Interface& interface, Bodies& bodies, double length) {
  double moved[2] = {0.0, 0.0};
  double spacing[2] = {0.0, 0.0};
  double step[2] = {0.0, 0.0};
  for (std::size_t s : {0u, 1u}) {
    const Side& side = interface.sides[s];
    const Description& body = bodies.describe(side.body);
    if (!body.can.obstacle) return 1 - static_cast<int>(s);
    const TimeGrid grid(0.0, length, body.step);
    const PortKernel& kernel = bodies.kernel(side.body, side.port, grid.count);
    moved[s] =
        std::accumulate(kernel.displacement.begin(), kernel.displacement.begin() + grid.count, 0.0);
    spacing[s] = body.ports[index(side.port)].geometry.spacing;
    step[s] = body.step;
  }
  if (moved[0] > similar * moved[1]) return 0;
  if (moved[1] > similar * moved[0]) return 1;
  if (spacing[0] != spacing[1]) return spacing[0] < spacing[1] ? 0 : 1;
  return step[1] < step[0] ? 1 : 0;
}

double stable_step_in_contact(const Interface& interface, Bodies& bodies, double length) {
  const double none = std::numeric_limits<double>::infinity();
  const Side& k = interface.kinematic_side();
  const Side& n = interface.neumann_side();
  const Description& body = bodies.describe(n.body);
  const TimeGrid grid(0.0, length, body.step);
  if (!std::isfinite(body.stable_step) || body.step <= 0.0 || grid.count < 2) return none;
  // A force at the end of a substep moves a node with mass in the next one only: by step^2 / m.
  const PortKernel& answer = bodies.kernel(n.body, n.port, grid.count);
  if (answer.displacement[0] != 0.0) return none;
  const TimeGrid spring_grid(0.0, length, bodies.describe(k.body).step);
  const PortKernel& spring = bodies.kernel(k.body, k.port, spring_grid.count);
  if (spring.compliance <= 0.0) return none;
  const double own = 2.0 / body.stable_step;
  const double added = answer.displacement[1] / (body.step * body.step * spring.compliance);
  return 2.0 / std::sqrt(own * own + added);
}

int tied_side(const Interface& interface, Bodies& bodies, double length) {
  const Description& a = bodies.describe(interface.sides[0].body);
  const Description& b = bodies.describe(interface.sides[1].body);
  const int coarser = coarser_side(interface, bodies);
  const bool able = coarser == 0 ? a.can.obstacle : b.can.obstacle;
  return able && a.step != b.step ? coarser : kinematic_side(interface, bodies, length);
}

int coarser_side(const Interface& interface, const Bodies& bodies) {
  const double step0 = bodies.describe(interface.sides[0].body).step;
  const double step1 = bodies.describe(interface.sides[1].body).step;
  return step1 > step0 ? 1 : 0;
}

}  // namespace abut
