#pragma once

#include "coordinator/coupling/joint.hpp"

namespace abut {

/// Whether what was before a side of a joint of surfaces, in the reference configuration, is behind
/// it in the last replies, or the other way round: they went through each other.
bool changed_places(const Joint& joint, const Bodies& bodies);

}  // namespace abut
