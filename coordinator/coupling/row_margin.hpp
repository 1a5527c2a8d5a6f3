#pragma once

#include <array>
#include <span>

#include "coordinator/coupling/bodies.hpp"

namespace abut {

/// [m] by which rows of two surfaces see them nearer than their facets are (docs/METHOD.md,
/// [M.102]).
double row_margin(const std::array<Side, 2>& sides, const Bodies& bodies);

/// The same of whichever two of many surfaces: not less than for any pair of them.
double row_margin_of_all(std::span<const Side> surfaces, const Bodies& bodies);

}  // namespace abut
