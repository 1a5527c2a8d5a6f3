#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "surface/mortar_pieces.hpp"
#include "surface/posed_surface.hpp"

namespace abut {

struct MergeBuffers {
  std::vector<std::int64_t> rank;  // (nodes of K)
};

/// Which row every node of K belongs to (n): its own, another node's, or -1 where N covers nothing.
/// A row whose weight is below `share` of the node's full weight joins the facet neighbour of most
/// weight, and goes with that one where it joins another in turn:
///   T_r = (w_i e_i + w_j e_j) / (w_i + w_j),   P_r = (w_i P_i + w_j P_j) / (w_i + w_j).
/// To leave such rows out would take their pressure from both sides' nodes, to keep them makes the
/// contact problem as ill-conditioned as their weights are unequal.
void merged_rows(const PosedSurface& k, const MortarPieces& pieces, std::span<const double> weight,
                 std::span<const double> full, double share, MergeBuffers& buffers,
                 std::vector<std::int32_t>& root);

}  // namespace abut
