#include "coordinator/record/recorded_bodies.hpp"

#include <algorithm>

namespace abut {

const Energy& RecordedBody::energy(const BodyRecord& record) const {
  return member < 0 ? record.energy : record.members[member].energy;
}

const std::vector<double>& RecordedBody::momentum(const BodyRecord& record) const {
  return member < 0 ? record.momentum : record.members[member].momentum;
}

std::vector<RecordedBody> recorded_bodies(const std::vector<const Description*>& bodies) {
  std::vector<RecordedBody> recorded;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Description& body = *bodies[b];
    const int index = static_cast<int>(b);
    if (body.members.empty()) recorded.push_back({index, -1, body.name, body.mass, body.dim});
    for (std::size_t m = 0; m < body.members.size(); ++m) {
      const Member& member = body.members[m];
      recorded.push_back({index, static_cast<int>(m), member.name, member.mass, body.dim});
    }
  }
  return recorded;
}

int recorded_body_of(const std::vector<const Description*>& bodies, int body, int port) {
  int before = 0;
  for (int b = 0; b < body; ++b)
    before += std::max(1, static_cast<int>(bodies[b]->members.size()));
  const std::vector<Member>& members = bodies[body]->members;
  for (std::size_t m = 0; m < members.size(); ++m) {
    const std::vector<std::int32_t>& ports = members[m].ports;
    if (std::find(ports.begin(), ports.end(), port) != ports.end())
      return before + static_cast<int>(m);
  }
  return before;
}

}  // namespace abut
