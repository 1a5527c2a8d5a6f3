#pragma once

#include "coordinator/coupling/joint.hpp"
#include "coordinator/coupling/watch.hpp"

namespace abut {

// How near the sides of a joint of surfaces are. `margin` [m] is counted as theirs.

/// How far the sides are apart at the end of the last replies, and how fast they may close.
Approach approach_of(const Joint& joint, double margin, const Bodies& bodies);

/// Whether the sides meet within `length` [s] if they go on at the speeds of their points in the
/// last replies, and half as fast again. What bodies foresee, and margins, are no part of it.
bool may_meet(const Joint& joint, const Bodies& bodies, double length);

/// Whether the boxes that the sides swept in the last replies were apart in every record's part.
bool swept_apart(const Joint& joint, double margin, const Bodies& bodies);

/// Whether the sides stayed apart over the last replies, which span `length` [s] from where
/// `before` was measured: their swept boxes did in every record's part, or what they were apart at
/// both ends is more than they can have come together in between. Sides that touched before may
/// have overlapped by roundings.
bool kept_apart(const Joint& joint, const Approach& before, double margin, const Bodies& bodies,
                double length);

}  // namespace abut
