#pragma once

#include <Eigen/Core>

#include "surface/boxes.hpp"
#include "surface/posed_surface.hpp"

namespace abut {

/// Whether a surface encloses something: in the plane every node belongs to an even number of
/// facets, in space every edge. For setting up: it allocates.
bool is_closed(const PosedSurface& surface);

/// Whether a point lies inside a closed surface: rays from it leave an odd number of times. Which
/// way facets look does not matter. `tree` holds boxes of this pose.
bool inside(const PosedSurface& surface, const BoxTree& tree, const Eigen::Vector3d& x);

}  // namespace abut
