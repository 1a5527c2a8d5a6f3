#pragma once

#include <string>

#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// Throws InputError with the numbers and places of two cells that have the same corners: the body
/// would have twice the stiffness and mass there. `where` is the file.
void refuse_repeated_cells(const Mesh& mesh, const std::string& where);

/// Settles what a file's groups of facets are: those between cells become node sets, as a side has
/// one cell at each facet; those on the boundary stay sides. Also sorts the node sets and drops
/// those that repeat a side of the same name. All of the boundary is the side "boundary", unless
/// the file calls something else so. Throws InputError naming the group when its facets are both
/// inside and on the boundary, when it has a facet twice, and when a side and a node set of one
/// name have different nodes; `where` is the file.
void settle_names(Mesh& mesh, const std::string& where);

}  // namespace abut
