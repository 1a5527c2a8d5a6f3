#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "surface/plane_facet.hpp"
#include "surface/posed_surface.hpp"

namespace abut {

/// Values of a facet's nodes, of which it has 2 or 3 in the plane, 3, 4, 6 or 8 in space: corners
/// first, then what lies between them, edge by edge. Entries beyond them are 0.
using Shape8 = Eigen::Matrix<double, 8, 1>;
using Slopes8 = Eigen::Matrix<double, 8, 2>;

/// A facet as its element has it, of first or second order, on the line [-1, 1], on the triangle
/// (0, 0), (1, 0), (0, 1) or on the square [-1, 1]^2.
struct FacetKind {
  int nodes = 2, corners = 2;

  FacetKind(int dim, std::size_t count);
  /// Linear, or bilinear, functions of the corners.
  Shape4 hats(const Eigen::Vector2d& at) const;
  /// Shape functions of the element and their slopes: corners L_c - 1/2 (those beside it).
  void evaluate(const Eigen::Vector2d& at, Shape8& n, Slopes8& slopes) const;
  /// Where a node is.
  Eigen::Vector2d place(int node) const;
};

/// Such a facet as it is seen in an auxiliary plane.
struct WholeFacet {
  FacetKind kind;
  Eigen::Matrix<double, 2, 8> x;  // [m] nodes; of segments the second is 0

  WholeFacet(const AuxiliaryPlane& plane, const PosedSurface& surface,
             std::span<const std::int32_t> nodes);
  /// Where the facet is seen at a point of the plane [m]: Newton's method from `guess`, which it
  /// answers where it finds nothing near.
  Eigen::Vector2d find(const Eigen::Vector2d& z, const Eigen::Vector2d& guess) const;
};

}  // namespace abut
