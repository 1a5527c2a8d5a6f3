#pragma once

#include <cstdint>
#include <vector>

#include "surface/posed_surface.hpp"

namespace abut {

/// Of two surfaces whose facets are the same ones, node by node: of every node of the first its
/// twin in the second. Empty where a facet of the first has no twin. Nodes are twins that lie
/// closer than 1e-6 of the shortest edge. The second may go on beyond the first.
std::vector<std::int32_t> twin_nodes(const PosedSurface& one, const PosedSurface& other);

/// Whether every facet of the first surface has a twin in the second, where its nodes have.
bool facets_meet(const PosedSurface& one, const PosedSurface& other,
                 const std::vector<std::int32_t>& twins);

}  // namespace abut
