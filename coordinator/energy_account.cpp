#include "coordinator/energy_account.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace abut {

EnergyAccount energy_account_of(const Joint& joint) {
  return joint.exchange == nullptr ? EnergyAccount::unknown : joint.exchange->energy_account();
}

namespace {

/// Bodies whose every exchange of energy is told. The published form overwrites motion, which does
/// work that nobody knows, and dashpots take what sides cannot follow.
std::vector<bool> conserving(std::span<const Joint> joints, const Bodies& bodies) {
  std::vector<bool> conserves;
  for (int b = 0; b < bodies.count(); ++b) conserves.push_back(bodies.describe(b).conserves);
  for (const Joint& joint : joints) {
    if (joint.exchange != nullptr && energy_account_of(joint) != EnergyAccount::unknown) continue;
    for (const Side& side : joint.sides) conserves[side.body] = false;
  }
  return conserves;
}

std::vector<EnergyGuard::Stepping> stepping(const Bodies& bodies) {
  std::vector<EnergyGuard::Stepping> all;
  for (int b = 0; b < bodies.count(); ++b) {
    const Description& body = bodies.describe(b);
    const bool moves = std::isfinite(body.mass) && !body.quasi_static;
    all.push_back(moves ? EnergyGuard::Stepping{body.mass, body.step} : EnergyGuard::Stepping{});
  }
  return all;
}

/// Whether what all bodies have together may not grow. Rows that close inside a step without
/// inertia leave an energy of the order of the step, whatever it is: nothing would be unstable. And
/// what bodies that exchange motions alone share is there twice.
bool sums(std::span<const Joint> joints, bool everything, const Bodies& bodies) {
  for (int b = 0; b < bodies.count() && everything; ++b)
    if (bodies.describe(b).quasi_static) return false;
  return std::ranges::none_of(joints, [&bodies](const Joint& joint) {
    const bool rests = std::ranges::any_of(joint.sides, [&bodies](const Side& side) {
      return bodies.describe(side.body).quasi_static;
    });
    return joint.tied() ? energy_account_of(joint) == EnergyAccount::doubled : rests;
  });
}

}  // namespace

EnergyGuard make_energy_guard(double share, std::span<const Joint> joints, bool everything,
                              const Bodies& bodies) {
  return {share, conserving(joints, bodies), sums(joints, everything, bodies), stepping(bodies)};
}

}  // namespace abut
