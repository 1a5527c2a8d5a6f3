#pragma once

#include "surface/boxes.hpp"
#include "surface/posed_surface.hpp"

namespace abut {

/// [m] a bound from below of the distance of two facets: the widest gap between them along the axes
/// of space, their mean normals and the line of their centres. Exact for facets that face each
/// other in parallel; 0: none of these parts them.
double facets_apart(const Corners& a, const Corners& b);

/// [m] the least of that over all pairs of facets of two surfaces, by trees with boxes of these
/// poses without a margin. Infinity: a surface has no facets.
double least_distance(const PosedSurface& a, const BoxTree& tree_a, const PosedSurface& b,
                      const BoxTree& tree_b);

}  // namespace abut
