#include "coordinator/coupling/work_of_contact.hpp"

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
  for (const Response& response : bodies.responses())
    for (const PortResponse& port : response.ports) lost -= port.work;
  for (const Joint& joint : joints) {
    const double told = friction_told(joint, bodies);
    if (told > 0.0) lost -= told - joint.contact.rubbed[index(joint.role.kinematic)];
  }
  return lost;
}

}  // namespace abut
