#pragma once

#include <Eigen/Core>

#include "surface/clip.hpp"
#include "surface/plane_facet.hpp"
#include "surface/posed_surface.hpp"

namespace abut {

/// How precisely the products of shape functions are integrated over the pieces of an overlap.
/// Exact, and the same, for segments, triangles and parallelograms; other quadrilaterals have
/// shape functions that are not polynomials in the auxiliary plane.
enum class PieceQuadrature {
  seven_points,      // per triangle of a piece
  four_times_seven,  // every triangle in four parts
};

/// A facet of the kinematic side as the ground on which the partner's facets are integrated.
struct GroundFacet {
  Corners corners;
  AuxiliaryPlane plane;
  PlaneFacet seen;
  Polygon polygon;
  Eigen::Vector2d low, high;  // [m] its extent in the plane
  double area = 0.0;          // [m^(dim-1)] of the whole facet
  bool round;                 // a ring about x = 0: integrals are over all of it

  explicit GroundFacet(const Corners& facet, bool round = false);
};

/// Integrals over what a ground facet (i) and a partner's facet (j) have in common when both are
/// seen in the ground's auxiliary plane [m^(dim-1)]; of rings, with the ground's radius, [m^2] but
/// for the area, which stays a length. Rows and columns beyond the corners are 0.
struct FacetOverlap {
  double area = 0.0;
  double gap = 0.0;                                 // [m] height of the partner at its middle
  Shape4 moments = Shape4::Zero();                  // int N_i
  Eigen::Matrix4d own = Eigen::Matrix4d::Zero();    // int N_i N_i'
  Eigen::Matrix4d mixed = Eigen::Matrix4d::Zero();  // int N_i N_j
};

/// Overlap and its integrals; false when there is none, or when the partner at the overlap's middle
/// is further away than `reach` [m], on either side. A pair counts as a whole or not at all: cut
/// pieces would make the dual rows jump.
bool integrate(const GroundFacet& ground, const Corners& partner, double reach,
               PieceQuadrature quadrature, FacetOverlap& overlap);

}  // namespace abut
