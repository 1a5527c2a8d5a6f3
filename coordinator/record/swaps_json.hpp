#pragma once

#include <span>

#include <nlohmann/json.hpp>

#include "coordinator/record/observer.hpp"

namespace abut {

/// What a summary tells of swaps: who, from what to what, and energies, momenta and masses before
/// and after (docs/OUTPUT.md).
nlohmann::ordered_json swaps_json(std::span<const Swap> swaps);

}  // namespace abut
