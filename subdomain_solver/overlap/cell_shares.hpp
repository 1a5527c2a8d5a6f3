#pragma once

#include <string>
#include <vector>

#include "subdomain_solver/overlap/mesh_simplices.hpp"

namespace abut {

/// Of the cells of one mesh, how much lies in another one: integrals of their shape functions over
/// the common part, of those over the whole cell.
struct CommonParts {
  struct Part {
    CellPlace cell;
    std::vector<double> of;  // (nodes) from 0 to about 1
  };
  std::vector<Part> parts;  // of cells with a common part, in the order of the mesh
  double volume = 0.0;      // [m^dim] of all that both meshes take
};

CommonParts common_parts(const MeshSimplices& own, const MeshSimplices& other);

}  // namespace abut
