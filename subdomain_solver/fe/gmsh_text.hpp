#pragma once

#include <string>

#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// A mesh in Gmsh's format MSH 4.1 (text), coordinates in the shortest form that reads back to the
/// same bits: gmsh_mesh of it has the same nodes, cells, sides and node sets in the same order.
/// Sides are physical groups of facets, node sets of points. Names of blocks are left out: they are
/// node sets as well.
std::string gmsh_text(const Mesh& mesh);

}  // namespace abut
