#include "coordinator/coupling/work_of_contact.hpp"

#include <set>
#include <utility>

#include "base/index.hpp"

namespace abut {

double friction_told(const Joint& joint, const Bodies& bodies) {
  const Side& side = joint.kinematic_side();
  if (joint.tied() || side.partner < 0) return 0.0;
  const PortResponse& reply = bodies.response(side.body).ports[index(side.port)];
  if (index(side.partner) >= reply.reactions.size()) return 0.0;
  return reply.reactions[index(side.partner)].dissipated;
}

double lost_to_contact(std::span<const Joint> joints, const Bodies& bodies) {
  double lost = 0.0;
  std::set<std::pair<int, int>> touched;
  for (const Joint& joint : joints) {
    for (const Side& side : joint.sides)
      if (!joint.tied() && touched.emplace(side.body, side.port).second)
        lost -= bodies.response(side.body).ports[index(side.port)].work;
    const double told = friction_told(joint, bodies);
    if (told > 0.0) lost -= told - joint.contact.rubbed[index(joint.role.kinematic)];
  }
  return lost;
}

}  // namespace abut
