#pragma once

#include <string>
#include <vector>

#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// The mesh of a file in Gmsh's format MSH 4.1 (text or binary) or 2.2 (text), with coordinates
/// times `scale` [m per unit of the file]. The elements of the highest dimension are the cells;
/// meshes in the plane or on a line must have constant other coordinates.
///
/// Physical groups become names: of cells, blocks and node sets; of their facets, sides; of facets
/// between cells, and of lower dimensions, node sets. A group without a name is called after its
/// dimension and tag: volume_3, surface_2, curve_1, point_7. Nodes of no cell are dropped. Prisms
/// and pyramids are divided into tetrahedra (divide_cells.hpp).
///
/// `surface_in`: dimensions of a space in which a file that has only facets is the surface of a
/// shape (surface_shape.hpp); 0: facets are cells. `notes` gets lines for people: what was divided.
///
/// Throws InputError with file and line (or byte): what cannot be read, groups with one name, and
/// sides that are no facets of cells. Call check_mesh on the result.
Mesh read_gmsh(const std::string& path, double scale = 1.0, int surface_in = 0,
               std::vector<std::string>* notes = nullptr);

/// The same of a file's bytes; `name` is for messages.
Mesh gmsh_mesh(std::string bytes, const std::string& name, double scale = 1.0, int surface_in = 0,
               std::vector<std::string>* notes = nullptr);

}  // namespace abut
