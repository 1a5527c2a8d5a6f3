#pragma once

#include "coordinator/coupling/joint.hpp"

namespace abut {

// How near the sides of a joint of surfaces are, by the boxes that their points sweep, the joint's
// margin around them.

/// [m] between the boxes in which the sides ended their last replies; 0: they overlap.
double distance(const Joint& joint, const Bodies& bodies);

/// Whether the boxes of the sides stayed apart in every record's part of the last replies.
bool boxes_apart(const Joint& joint, const Bodies& bodies);

/// [m/s] at which their points may approach each other; infinity: unknown.
double closing_bound(const Joint& joint, const Bodies& bodies);

}  // namespace abut
