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
/// weight whose gap [m] (n) differs by less than `level` of the node's size, and goes with that one
/// where it joins another in turn:
///   T_r = (w_i e_i + w_j e_j) / (w_i + w_j),   P_r = (w_i P_i + w_j P_j) / (w_i + w_j).
/// To leave such rows out would take their pressure from both sides' nodes, to keep them makes the
/// contact problem as ill-conditioned as their weights are unequal. Around a contact of curved
/// faces are rows with little support too, but apart: merged with them, the contact's rim would see
/// their gaps and overlap by as much.
void merged_rows(const PosedSurface& k, const MortarPieces& pieces, std::span<const double> weight,
                 std::span<const double> full, std::span<const double> gap, double share,
                 double level, MergeBuffers& buffers, std::vector<std::int32_t>& root);

/// Whether a row has less than this share of its node's full weight.
bool is_light(double weight, double full, double share);

}  // namespace abut
