#pragma once

#include <string>

#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// The mesh of an Exodus II file (NetCDF classic or NetCDF-4), with coordinates times `scale` [m
/// per unit of the file]. Element blocks become blocks and node sets, side sets become sides (those
/// between cells, node sets), node sets stay. Sets without a name are called block_7, surface_7 and
/// nodelist_7 after their id, as Sierra does. Nodes of no cell are dropped.
///
/// Throws InputError with the file and the variable: what cannot be read, elements that we do not
/// have, numbers out of range, two sets with one name; and, in a program built without NetCDF,
/// always. Call check_mesh on the result.
Mesh read_exodus(const std::string& path, double scale = 1.0);

}  // namespace abut
