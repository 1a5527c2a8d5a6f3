#pragma once

#include "coordinator/coupling/joint.hpp"

namespace abut {

// How near the sides of a joint of surfaces are, the joint's margin counted as theirs.

/// Notes in joint.approach how far its sides are apart at the end of the last replies, and how fast
/// they may close. What is noted stays where the last replies were of an attempt that was taken
/// back.
void measure_approach(Joint& joint, const Bodies& bodies);

/// Whether the boxes that the sides swept in the last replies were apart in every record's part.
bool swept_apart(const Joint& joint, const Bodies& bodies);

/// Whether the sides stayed apart over the last replies, which span `length` [s] from where
/// joint.approach was measured: their swept boxes did in every record's part, or what they were
/// apart at both ends is more than they can have come together in between.
bool kept_apart(const Joint& joint, const Bodies& bodies, double length);

}  // namespace abut
