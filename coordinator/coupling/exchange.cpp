#include "coordinator/coupling/exchange.hpp"

namespace abut {

void Exchange::introduce(Joint& joint, Bodies& bodies) {
  if (met_) return;
  met_ = bodies.next_meeting();
  ContactLaw law = law_;
  law.tied = joint.tied();
  for (const std::size_t s : {0u, 1u})
    bodies.meet(joint.sides[s], bodies.port(joint.sides[1 - s]).geometry, law);
}

KnownExchanges known_exchanges(std::span<const Joint> joints) {
  KnownExchanges known;
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (joints[j].exchange != nullptr) joints[j].exchange->enter(joints[j], j, known);
  return known;
}

std::vector<bool> share_nodes(std::span<const Joint> joints) {
  std::vector<bool> share;
  for (const Joint& joint : joints) share.push_back(joint.tied());
  for (const auto& [joint, tie, part] : known_exchanges(joints).ties) share[part] = false;
  return share;
}

}  // namespace abut
