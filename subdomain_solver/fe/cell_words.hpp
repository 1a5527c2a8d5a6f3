#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// What the file that a mesh was read from calls a cell of a block: "element 7 (C3D8),
/// part.inp:12". None: the reader does not tell.
using CellWords = std::function<std::string(std::size_t block, std::size_t cell)>;

/// As check_mesh of mesh.hpp; of inverted cells the words stand beside the number.
void check_mesh(const Mesh& mesh, const std::string& where, const CellWords& words);

}  // namespace abut
