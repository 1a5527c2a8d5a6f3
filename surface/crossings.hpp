#pragma once

#include <vector>

#include "surface/boxes.hpp"
#include "surface/posed_surface.hpp"

namespace abut {

struct Crossings {
  int count = 0;    // pairs of facets
  FacetPair first;  // the smaller facet first
};

/// Facets of a surface that pass through each other: pairs without a common node of which an edge
/// of one goes through the inside of the other, farther than a millionth of the facet.
/// Quadrilaterals are seen as two triangles. Facets that lie on each other, as those of a slit, do
/// not cross. `tree` holds the surface's boxes in this pose. No allocation once `pairs` has grown.
Crossings crossings(const PosedSurface& surface, const BoxTree& tree,
                    std::vector<FacetPair>& pairs);

}  // namespace abut
