#pragma once

#include <Eigen/Core>
#include <vector>

#include "surface/facet_overlap.hpp"

namespace abut {

/// A point of what two straight facets have in common, in the auxiliary plane of the first.
struct OverlapPoint {
  Eigen::Vector2d z;  // [m]
  double weight;      // [m^(dim-1)], of rings [m^2]
  Shape4 at_k, at_n;  // of the corners of either
};

/// Points that integrate any polynomial over the overlap up to degree 10, and smooth functions as
/// well as such polynomials follow them. Replaces what `points` held, by none where the facets have
/// nothing in common or where the partner is further away than `reach` [m] at the overlap's middle.
void overlap_points(const GroundFacet& ground, const Corners& partner, double reach,
                    std::vector<OverlapPoint>& points);

}  // namespace abut
