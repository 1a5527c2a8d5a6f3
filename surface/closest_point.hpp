#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>

#include "surface/boxes.hpp"
#include "surface/plane_facet.hpp"
#include "surface/posed_surface.hpp"

namespace abut {

/// Where on a facet a point lies.
enum class FacetFeature { inside, edge, vertex };

struct ClosestPoint {
  Eigen::Vector3d point;  // [m] on the facet
  Shape4 shape;           // shape functions there: point = sum shape_i x_i
  double distance = 0.0;  // [m] never negative
  FacetFeature feature = FacetFeature::inside;
  int index = -1;  // edge i: from corner i to the next; vertex i; inside: -1
  // local coordinates: from 0 to 1 along the edges from corner 0 of a triangle, the first of them
  // along a segment; from -1 to 1 in a quadrilateral
  std::array<double, 2> local{};
};

/// The point of a facet that is closest to x: of a segment and a triangle in closed form; of a
/// bilinear quadrilateral its edges in closed form and the inside by Newton's method, held inside
/// and made to descend.
ClosestPoint closest_point(const Corners& facet, const Eigen::Vector3d& x);

struct SurfacePoint {
  int facet = -1;
  ClosestPoint at;
};

/// Which facets of a surface a search may answer with.
struct ClosestSearch {
  double reach = std::numeric_limits<double>::infinity();  // [m]
  // facets whose mean normal n has n.against <= -facing; all of them as it stands
  Eigen::Vector3d against = Eigen::Vector3d::Zero();
  double facing = 0.0;
};

/// The point of a surface that is closest to x, by a tree with boxes of this pose and of any
/// margin; of facets at the same distance the first. Nothing when no facet is within reach.
std::optional<SurfacePoint> closest_point(const PosedSurface& surface, const BoxTree& tree,
                                          const Eigen::Vector3d& x,
                                          const ClosestSearch& search = {});

}  // namespace abut
