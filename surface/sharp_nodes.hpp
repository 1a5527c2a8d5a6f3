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

/// Nodes that contact takes for those of sharp edges where facets of `size` [m] meet the surface:
/// at edges that turn by more than sharp_edge, or where it turns by more than half of that over
/// `size` [M.160].
std::vector<std::int32_t> edge_nodes(const PosedSurface& surface, double size);

/// One of these edges. In the plane both ends are the corner's.
struct SharpEdge {
  std::array<std::int32_t, 2> ends;    // nodes, ascending
  std::array<std::int32_t, 2> facets;  // beside it, ascending
};

/// In the order of their ends. With a `length` [m] edges are sharp, too, where the surface turns by
/// more than `angle` over such a length.
std::vector<SharpEdge> sharp_edges(const PosedSurface& surface, double angle, double length = 0.0);

}  // namespace abut
