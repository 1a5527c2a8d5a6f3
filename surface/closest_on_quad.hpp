#pragma once

#include <Eigen/Core>
#include <optional>

#include "surface/plane_facet.hpp"
#include "surface/posed_surface.hpp"

namespace abut {

/// Shape functions of the point inside a bilinear quadrilateral at which the distance from x is
/// least, found from a first guess; nothing when the descent ends on an edge.
std::optional<Shape4> stationary_on_quad(const Corners& quad, const Eigen::Vector3d& x,
                                         const Shape4& guess);

}  // namespace abut
