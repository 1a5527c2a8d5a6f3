#pragma once

#include <optional>

#include "subdomain_solver/overlap/cell_shares.hpp"

namespace abut {

/// Of the cells that a mesh shares with another one, the first that is no cell of that one too, of
/// the same nodes, which meet to a millionth of a cell. Nothing: the meshes conform.
std::optional<CellPlace> first_without_twin(const CommonParts& common, const Mesh& own,
                                            const Mesh& other);

}  // namespace abut
