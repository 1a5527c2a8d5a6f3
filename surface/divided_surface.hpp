#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "surface/posed_surface.hpp"
#include "surface/sparse_rows.hpp"

namespace abut {

/// A surface whose facets are divided evenly, all into as many parts along their edges: the same
/// shape with nodes as near to each other as another surface's. Its nodes follow the surface's.
struct DividedSurface {
  int dim = 3;
  bool round = false;                         // the same
  std::vector<std::int32_t> facets, offsets;  // as those of PosedSurface
  SparseRows nodes;                           // of its nodes over those of the surface

  int node_count() const { return nodes.count(); }
};

/// Parts along an edge that leave no edge longer than `size` [m].
int parts_for(const PosedSurface& surface, double size);

/// `parts`: at least 1, which leaves the surface as it is. For setting up: it allocates.
DividedSurface divided(const PosedSurface& surface, int parts);

}  // namespace abut
