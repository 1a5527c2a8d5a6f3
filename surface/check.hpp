#pragma once

#include <array>
#include <optional>
#include <string>

#include "surface/posed_surface.hpp"

namespace abut {

/// What makes a surface unusable. All other functions of this folder rely on its absence.
enum class SurfaceDefect {
  dimension,      // neither 2 nor 3
  points,         // no whole number of points
  offsets,        // do not grow from 0 to the size of `facets`
  node_count,     // a facet is no segment in the plane, no triangle or quadrilateral in space
  missing_node,   // a facet has a node that is not there
  repeated_node,  // a facet has a node twice
  not_finite,     // a facet has a node whose coordinates are not finite
  no_area,        // of a facet: less than 1e-12 of the square of its longest edge (in the plane:
                  // a segment without length)
  folded,         // a quadrilateral is not convex in its mean plane
  turned          // runs along an edge (in the plane: through a node) as its neighbour does
};

struct UnsoundSurface {
  SurfaceDefect defect;
  int facet = -1;  // -1: the surface as a whole
};

/// The first defect in the order of facets; nothing when the surface is sound. To be called once
/// for a surface that comes from outside; it visits every facet.
std::optional<UnsoundSurface> check(const PosedSurface& surface);

/// The two triangles, by places of its corners, into which a quadrilateral divides that is not
/// convex in its mean plane: without a fold where one corner is not, with the lesser one where it
/// is so warped that two are not. None: it is convex, or a bow.
std::optional<std::array<std::array<int, 3>, 2>> unfolding(const Corners& quadrilateral);

/// The defect as the words of a message: "facet 3 has no area".
std::string words(const UnsoundSurface& unsound);

}  // namespace abut
