#pragma once

#include <string>

#include "subdomain_solver/fe/file_mesh.hpp"

namespace abut {

/// Reads the bytes of a file in Gmsh's format MSH 4.1, text or binary of this machine's byte order,
/// or 2.2, text. Prisms and pyramids of first and second order are told as cells that are divided.
/// Throws InputError with line or byte: other versions, partitioned meshes, elements that we do not
/// have, damage.
FileMesh parse_gmsh(std::string bytes, const std::string& name);

}  // namespace abut
