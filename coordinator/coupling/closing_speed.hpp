#pragma once

#include <cstddef>

#include "coordinator/coupling/joint.hpp"

namespace abut {

/// [m/s] How fast two surfaces came together along the normal of their contact when a substep of
/// the latest replies began in which they press: `substep` counts the times of the reaction of the
/// kinematic side, from 1. Points count by their force; how fast the sides slide has no part in it.
/// `rubs`: the law has friction, so that the force leans.
double closing_speed_before(const Joint& joint, bool rubs, const Bodies& bodies,
                            std::size_t substep);

}  // namespace abut
