#include "coordinator/energy_guard.hpp"

#include <algorithm>
#include <utility>

namespace abut {

EnergyGuard::Verdict EnergyGuard::look(std::span<const Response> responses) {
  double own = 0.0, motion = 0.0;
  for (const Response& response : responses) {
    const Energy& energy = response.records.back().energy;
    own += energy.total() - energy.external_work;
    motion += energy.kinetic + energy.stored;
  }
  if (!begun_) {
    begun_ = true;
    first_ = own;
  }
  most_ = std::max(most_, motion);
  growth_ = most_ > 0.0 ? (own - first_) / most_ : 0.0;
  if (growth_ > share_) return Verdict::fail;
  if (growth_ <= 0.5 * share_ || std::exchange(warned_, true)) return Verdict::fine;
  return Verdict::warn;
}

}  // namespace abut
