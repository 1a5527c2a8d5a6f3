#pragma once

#include "coordinator/coupling/joint.hpp"

namespace abut {

/// Whether stresses of the start, which no contact bears yet, have let the sides of a joint of
/// surfaces spring into each other. False of sides that stand where they were put: whether these
/// may overlap was judged before.
bool sprang_together(const Joint& joint, const Bodies& bodies);

}  // namespace abut
