#pragma once

#include <vector>

#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// The surface of a placed mesh, of straight pieces: segments in the plane, triangles in space.
struct PlacedSurface {
  int corners = 0;              // of a piece: 2 or 3
  std::vector<double> points;   // [m] (nodes, 3)
  std::vector<int> pieces;      // (pieces, corners)
  std::vector<int> used_nodes;  // of pieces
};

PlacedSurface placed_surface(const Mesh& mesh, const std::vector<double>& position, double scale);

/// [m] How far the first surface can go along x until a node of one meets a piece of the other;
/// infinite where it goes past. Edges that meet edges alone are not seen.
double facing_distance(const PlacedSurface& behind, const PlacedSurface& ahead);

}  // namespace abut
