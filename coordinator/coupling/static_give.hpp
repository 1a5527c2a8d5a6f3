#pragma once

#include "coordinator/coupling/bodies.hpp"
#include "coordinator/coupling/joint.hpp"

namespace abut {

/// [m/N] by which a side without inertia is deformed where forces on all points of its port sum up
/// to 1 N; 0: not known, or rigid  [M.144].
double static_give(const Side& side, Bodies& bodies);

}  // namespace abut
