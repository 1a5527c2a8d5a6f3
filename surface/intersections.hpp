#pragma once

#include <Eigen/Core>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "surface/skin_trees.hpp"

namespace abut {

/// An edge that passes through a facet, by their places in the skin's lists. In the plane the edge
/// is a facet, too, and two facets that cross are told twice, once as an edge each.
struct Intersection {
  std::int32_t edge = 0, facet = 0;

  auto operator<=>(const Intersection&) const = default;
};

/// Edges that pass through facets by more than `depth` [m], ascending, for an edge and a facet
/// without a common point: those that no shift of the edge by `depth` frees from the facet and its
/// neighbours, seen by signs of volumes, whatever distances say. Surfaces that touch, also along
/// edges and faces, do not intersect; an edge that goes exactly through a node or an edge between
/// facets does. Of bodies that overlap with flush sides no edge does; there the nodes' sides tell
/// (signed_side.hpp). `depth` must be above the rounding of places. What `found` held is dropped.
/// Renews the trees' boxes.
void intersections(SkinTrees& trees, std::span<const Eigen::Vector3d> points, double depth,
                   const FeatureChoice& choice, std::vector<Intersection>& found);

}  // namespace abut
