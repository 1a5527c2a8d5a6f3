#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "surface/posed_surface.hpp"

namespace abut {

/// A place that two bodies share.
struct OverlapPlace {
  enum class What { node, facet, edge };  // a node, the middle of a facet; an edge that passes
  double depth = 0.0;                     // [m]
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  What what = What::node;
  int surface = 0;  // 0 or 1: whose it is; it is in the body of the other
};

struct OverlapChoice {
  std::array<double, 2> allowed{};  // [m] depth of nodes of either surface that is none
  double reach = 0.0;               // [m] behind a surface that encloses nothing
};

/// Where bodies overlap whose surfaces these are, deepest first; facets look out of their bodies.
/// A node, or the middle of a facet, is in a body where it is behind the closest facet of all,
/// however far: of a surface that encloses nothing only within reach, where it faces the facet and
/// lies over it. Facets on each other that look the same way overlap, too. Where no such place is
/// nearly as deep, one edge is told that passes through a facet, the deepest, with the shift that
/// frees it. For setting up: it allocates.
std::vector<OverlapPlace> overlap_places(const PosedSurface& one, const PosedSurface& other,
                                         const OverlapChoice& choice);

/// Whether a place is before a closed surface, nearer to it than `distance` [m]. For setting up: it
/// allocates.
bool is_before(const PosedSurface& surface, const Eigen::Vector3d& x, double distance);

/// The deepest places that are farther apart than `distance` [m], as many as are asked for.
std::vector<OverlapPlace> parted_places(const std::vector<OverlapPlace>& places, double distance,
                                        int most);

}  // namespace abut
