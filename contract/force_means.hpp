#pragma once

#include <span>
#include <vector>

#include "contract/substeps.hpp"

namespace abut {

/// [s] (count + 1) begin and ends of substeps.
std::vector<double> levels_of(const Substeps& grid);

/// How a body of levels `here` [s] takes a force that is linear between its values at the times
/// `source` [s]: (here, source) parts of those values at each level, means over the dual cells
/// around levels, so that the impulse over the window is exact. Where both are the same times: the
/// values themselves. Both begin and end together, ascending.
std::vector<double> force_means(std::span<const double> here, std::span<const double> source);

}  // namespace abut
