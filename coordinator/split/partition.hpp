#pragma once

#include <string>
#include <vector>

#include "coordinator/split/cell_graph.hpp"

namespace abut {

/// Deals the cells to `parts` connected parts of about equal numbers with few facets between them
/// (METIS, k-way on the dual graph): of every cell its part, numbered in the order of their first
/// cells. The same graph gives the same parts. Throws InputError where the mesh is of several
/// pieces or has too few cells; `where` names it.
std::vector<int> partition(const CellGraph& graph, int parts, const std::string& where);

}  // namespace abut
