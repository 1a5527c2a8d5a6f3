#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "surface/posed_surface.hpp"

namespace abut {

/// Several surfaces as one set of simplices, whose points are those of all surfaces in their order.
/// Quadrilaterals are split along the diagonal from their first to their third node, as they are
/// wherever their crossings are looked for. Facets keep the way that they look.
struct Skin {
  int dim = 3;
  std::vector<std::array<std::int32_t, 3>> facets;  // in the plane the third is -1
  // each once, its smaller point first, ascending, diagonals too; in the plane none
  std::vector<std::array<std::int32_t, 2>> edges;
  std::vector<std::int32_t> nodes;  // points that a facet has, ascending
  std::vector<std::int32_t> group;  // by point: which surface it is of
  int groups = 0;

  int point_count() const { return static_cast<int>(group.size()); }
  int facet_points() const { return dim == 2 ? 2 : 3; }
};

/// Of surfaces of one dimension. It allocates.
Skin skin_of(std::span<const PosedSurface> surfaces);

}  // namespace abut
