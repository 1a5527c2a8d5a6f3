#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "surface/boxes.hpp"
#include "surface/posed_surface.hpp"
#include "surface/surface_rows.hpp"

namespace abut {

enum class RowNormal {
  facet,  // of the facet of N that holds the foot
  nodal,  // N's nodal normals interpolated at the foot: continuous along N, for sharp nodes of K
};

struct PointRowOptions {
  double reach = std::numeric_limits<double>::infinity();  // [m] from a node to its foot
  // facets of N are met when n.n_N <= -facing, n the normal of K at the node
  double facing = 0.5;
  // How far beside its facet's edge a node may lie, in facet sizes, and still be joined. Above
  // zero, so that a node on N's rim does not come and go with round-off.
  double rim = 0.02;
  RowNormal normal = RowNormal::facet;
  // [m] nodes further behind N are left out where they see its facet through N (far_sides.hpp); of
  // poses in which bodies do not overlap by more than they are thick
  double thinnest = std::numeric_limits<double>::infinity();
};

/// Memory that calls of point_rows use again; its contents mean nothing between them.
struct PointRowBuffers {
  std::vector<double> k_normals, n_normals;  // (nodes, dim)
  std::vector<double> weights;               // (nodes of K)
};

/// Closest-point rows (node to segment): T = e_j, P = N's shape functions at the foot of node j,
/// for the given nodes of K, ascending. They balance forces as mortar rows do, and with normals of
/// facets moments exactly, but a constant pressure does not pass through them. `tree` holds N's
/// boxes in this pose.
void point_rows(const PosedSurface& k, std::span<const std::int32_t> nodes, const PosedSurface& n,
                const BoxTree& tree, const PointRowOptions& options, PointRowBuffers& buffers,
                SurfaceRows& rows);

}  // namespace abut
