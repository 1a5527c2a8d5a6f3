#pragma once

#include <string_view>
#include <vector>

#include "subdomain_solver/fe/file_mesh.hpp"
#include "subdomain_solver/fe/shape_functions.hpp"

namespace abut {

/// A shape of cells that files may have and we have no element of.
struct DividedShape {
  std::string_view name, plural;
  int corners = 0;
  std::vector<std::vector<int>> faces;  // corners; normals point outwards
  /// Edges in the order in which Gmsh's nodes between corners follow the corners.
  std::vector<Edge> edges;

  int nodes(bool quadratic) const {
    return corners + (quadratic ? static_cast<int>(edges.size()) : 0);
  }
};
/// The pyramid over a square and the prism over a triangle.
const DividedShape& pyramid_shape();
const DividedShape& prism_shape();

/// Divides what `divided` has into tetrahedra, and with it every hexahedron and the quadrilaterals
/// on its faces, so that cells still meet in whole faces. Every cell is divided from its smallest
/// node, and so is each of its faces: two cells that share a face divide it alike, by the diagonal
/// through its smallest node (J. Dompierre, P. Labbe, M.-G. Vallet, R. Camarero, How to subdivide
/// pyramids, prisms and hexahedra into tetrahedra, 1999). Cells of second order become tetrahedra
/// of second order; a node that a diagonal needs is where the cell's own functions have its middle.
/// Adds a note. Does nothing to files without such cells.
void divide_cells(FileMesh& file);

}  // namespace abut
