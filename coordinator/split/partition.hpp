#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/split/cell_graph.hpp"

namespace abut {

/// Cells that must not be parted: all around each of these nodes. Of every cell the number of what
/// it goes with, ascending from 0 in the order of the first cells.
std::vector<int> kept_together(const Mesh& mesh, const std::vector<std::int32_t>& nodes);

/// Deals the cells to `parts` connected parts of about equal numbers with few facets between them
/// (METIS, k-way on the dual graph): of every cell its part, numbered in the order of their first
/// cells. Cells of one number in `together` (cells) stay in one part. The same graph gives the same
/// parts. Throws InputError where the mesh is of several pieces or cannot be dealt to so many
/// parts; `where` names it.
std::vector<int> partition(const CellGraph& graph, const std::vector<int>& together, int parts,
                           const std::string& where);

}  // namespace abut
