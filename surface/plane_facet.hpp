#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

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
  bool affine = true;                // shape functions have a straight inverse
  std::array<Eigen::Vector2d, 4> x;  // [m] corners
  Eigen::Vector2d c0, ca, cb, cab;   // x = c0 + ca a + cb b + cab a b
  Eigen::Vector2d da, db;            // [1/m] a = da.(x - c0), b = db.(x - c0) when affine
  // b of x = c0 + r otherwise: square b^2 + (linear + to_linear.r) b + to_constant.r = 0
  double square, linear;
  Eigen::Vector2d to_linear, to_constant;

  /// Values at a point of the plane; unique inside a convex quadrilateral.
  Shape4 shape(const Eigen::Vector2d& z) const {
    const Eigen::Vector2d r = z - c0;
    if (!affine) return bilinear(inverse(r));
    const Eigen::Vector2d ab(da.dot(r), db.dot(r));
    if (count == 4) return bilinear(ab);
    return {1.0 - ab.x() - ab.y(), ab.x(), ab.y(), 0.0};
  }
  /// Corners counterclockwise, whichever way the facet turns in this plane.
  Polygon polygon() const;

 private:
  static Shape4 bilinear(const Eigen::Vector2d& p) {
    const double a = 0.25 * p.x(), b = p.y(), low = 0.25 - a, high = 0.25 + a;
    return {low * (1.0 - b), high * (1.0 - b), high * (1.0 + b), low * (1.0 + b)};
  }
  /// Coordinates a, b of c0 + r in a quadrilateral. The derivative of the equation of b is -J at
  /// its root, J > 0 the Jacobian of the map: that tells which root is meant, also where the
  /// quadratic term vanishes. Near the corner of a facet that is almost folded the root loses
  /// digits, which a Newton step brings back.
  Eigen::Vector2d inverse(const Eigen::Vector2d& r) const {
    const double q = linear + to_linear.dot(r), c = to_constant.dot(r);
    const double jacobian_square = std::max(0.0, q * q - 4.0 * square * c);
    const double jacobian = std::sqrt(jacobian_square);
    const double b = q < 0.0 ? 2.0 * c / (jacobian - q) : -(q + jacobian) / (2.0 * square);
    const Eigen::Vector2d along = ca + cab * b;
    const Eigen::Vector2d ab(along.dot(r - cb * b) / along.squaredNorm(), b);
    return jacobian_square < 0.0625 * q * q ? corrected(r, ab) : ab;
  }
  Eigen::Vector2d corrected(const Eigen::Vector2d& r, const Eigen::Vector2d& ab) const;
};

PlaneFacet seen_in(const AuxiliaryPlane& plane, const Corners& facet);

}  // namespace abut
