#pragma once

#include <array>
#include <vector>

#include "coordinator/coupling/joint.hpp"

namespace abut {

/// Of pairs of ports: whether both are ends of bars that share a node, and somewhere along the row
/// of bars that do, two step apart. Then all nodes of the row are joined as surfaces are, by forces
/// that are constant in steps: a body is advanced in one form or the other.
std::vector<bool> step_apart(const std::vector<std::array<Side, 2>>& pairs, const Bodies& bodies);

}  // namespace abut
