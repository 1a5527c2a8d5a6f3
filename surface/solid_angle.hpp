#pragma once

#include <Eigen/Core>

#include "surface/posed_surface.hpp"

namespace abut {

/// [sr], in the plane [rad]: the angle that a surface takes of the view from a point, what is seen
/// from its outer side positive and from its inner side negative. 0 outside a closed surface, minus
/// the full angle inside. METHOD.md, [M.159]; quadrilaterals as two triangles.
double solid_angle(const PosedSurface& surface, const Eigen::Vector3d& x);

}  // namespace abut
