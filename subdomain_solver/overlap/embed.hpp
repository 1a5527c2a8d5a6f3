#pragma once

#include <vector>

#include "subdomain_solver/overlap/embedded_surface.hpp"
#include "subdomain_solver/overlap/mesh_simplices.hpp"

namespace abut {

/// How far a boundary sticks out of cells.
struct StickingOut {
  double distance = 0.0;                 // [m] at most
  Eigen::Vector3d at = {0.0, 0.0, 0.0};  // [m] there
};

/// Another body's boundary in the cells of this one, whose own boundary is `skin`. Parts outside
/// are left out, and told of.
EmbeddedSurface embed(const BoundarySimplices& boundary, const MeshSimplices& cells,
                      const BoundarySimplices& skin, StickingOut& out);

/// Nodes of a mesh that lie in cells of another one, ascending, and in which.
struct HeldNode {
  std::int32_t node = 0;
  CellPlace cell;
};
std::vector<HeldNode> held_nodes(const Mesh& mesh, const MeshSimplices& cells);

/// Adds a point without facets, at a place [m] that moves as its cell does, or with one node alone.
void add_point(const Mesh& mesh, const Eigen::Vector3d& at, CellPlace cell, EmbeddedSurface& to);
void add_node(const Mesh& mesh, std::int32_t node, EmbeddedSurface& to);

/// [m] from a place to a boundary.
double distance(const BoundarySimplices& boundary, const Eigen::Vector3d& at);

}  // namespace abut
