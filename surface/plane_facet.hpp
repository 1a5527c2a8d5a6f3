#pragma once

#include <Eigen/Core>
#include <array>

#include "surface/clip.hpp"
#include "surface/posed_surface.hpp"

namespace abut {

/// A plane across a facet's mean normal through its centre, with coordinates in it: the auxiliary
/// plane on which a pair of facets is compared. In the plane it is the line of the segment, of
/// which only the first coordinate counts.
struct AuxiliaryPlane {
  Eigen::Vector3d origin;                 // [m]
  Eigen::Vector3d normal, first, second;  // unit, right-handed

  Eigen::Vector2d project(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d d = x - origin;
    return {first.dot(d), second.dot(d)};
  }
  double height(const Eigen::Vector3d& x) const { return normal.dot(x - origin); }  // [m]
};

/// The first axis follows the facet's first edge, so that the plane turns with the facet.
AuxiliaryPlane auxiliary_plane(const Corners& facet);

/// Shape functions of a facet of `count` corners; entries beyond them are 0.
using Shape4 = Eigen::Vector4d;

/// A facet as it is seen in an auxiliary plane: the inverse of its projected map.
struct PlaneFacet {
  int count = 0;
  bool affine = true;                // shape functions are linear: no or a straight inverse
  std::array<Eigen::Vector2d, 4> x;  // [m] corners
  Eigen::Vector2d c0, ca, cb, cab;   // x = c0 + ca a + cb b + cab a b

  /// Values at a point of the plane. For quadrilaterals the coordinates a, b of the point are found
  /// in closed form and corrected by one Newton step; unique inside a convex quadrilateral.
  Shape4 shape(const Eigen::Vector2d& z) const;
  /// Corners counterclockwise, whichever way the facet turns in this plane.
  Polygon polygon() const;
};

PlaneFacet seen_in(const AuxiliaryPlane& plane, const Corners& facet);

}  // namespace abut
