#pragma once

#include <span>

#include "coordinator/coupling/bodies.hpp"
#include "coordinator/coupling/joint.hpp"

namespace abut {

/// [J] by friction since the run began, as the side that finds a joint's contact tells it; 0 where
/// it tells none.
double friction_told(const Joint& joint, const Bodies& bodies);

/// [J] that the bodies have lost to each other in the window that they answered last: what forces
/// on ports that touch took beside friction; those of ties are left out. Negative: they gained it.
double lost_to_contact(std::span<const Joint> joints, const Bodies& bodies);

}  // namespace abut
