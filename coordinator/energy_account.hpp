#pragma once

#include <span>

#include "coordinator/coupling/exchange.hpp"
#include "coordinator/energy_guard.hpp"

namespace abut {

/// What is known of the energy that passes through a joint; of contact inside a body: nothing.
EnergyAccount energy_account_of(const Joint& joint);

/// The guard of a run: which bodies it watches by themselves, and whether it watches their sum.
/// `everything`: surfaces that no interface joins may touch as well.
EnergyGuard make_energy_guard(double share, std::span<const Joint> joints, bool everything,
                              const Bodies& bodies);

}  // namespace abut
