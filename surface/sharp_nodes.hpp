#pragma once

#include <array>
#include <cstdint>
#include <numbers>
#include <vector>

#include "surface/posed_surface.hpp"

namespace abut {

/// [rad] Edges that turn by more are sharp to contact.
inline constexpr double sharp_edge = std::numbers::pi / 6.0;

/// Nodes at convex edges (in the plane: corners) whose two facets turn by more than `angle` [rad],
/// ascending: where averaged normals mean nothing and a row of its own takes the node to the
/// partner's closest point (point_rows with nodal normals). Edges of one facet, a surface's rim,
/// and hollow edges are not sharp. For setting up: it allocates.
std::vector<std::int32_t> sharp_nodes(const PosedSurface& surface, double angle);

/// One of these edges. In the plane both ends are the corner's.
struct SharpEdge {
  std::array<std::int32_t, 2> ends;    // nodes, ascending
  std::array<std::int32_t, 2> facets;  // beside it, ascending
};

/// In the order of their ends.
std::vector<SharpEdge> sharp_edges(const PosedSurface& surface, double angle);

}  // namespace abut
