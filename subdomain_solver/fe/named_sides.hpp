#pragma once

#include <string>

#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// Settles what a file's groups of facets are: those between cells become node sets, as a side has
/// one cell at each facet; those on the boundary stay sides. Also sorts the node sets and drops
/// those that repeat a side of the same name. Throws InputError naming the group when its facets
/// are both inside and on the boundary, when it has a facet twice, and when a side and a node set
/// of one name have different nodes; `where` is the file.
void settle_names(Mesh& mesh, const std::string& where);

}  // namespace abut
