#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contract/field.hpp"
#include "contract/subdomain.hpp"
#include "surface/boxes.hpp"
#include "surface/posed_surface.hpp"

namespace abut {

/// The outside of a body, wherever its ports are, in one pose.
struct BodyHull {
  int dim = 0;                                // 0: not known
  std::vector<std::int32_t> nodes;            // of the grid, by point; empty: points are of a port,
  std::size_t port = 0;                       // of this one
  std::vector<double> reference;              // [m] (n, dim)
  std::vector<double> points;                 // [m] (n, dim) in the pose
  std::vector<std::int32_t> facets, offsets;  // as those of a PosedSurface; in 1D none
  double size = 0.0;                          // [m] of a facet, typically; in 1D of a cell
  int endless = 0;                            // in 1D: it goes on without end to this side, -1 or 1
  Box box = {};                               // of the pose

  PosedSurface surface() const { return {dim, points, facets, offsets}; }
};

/// That of a grid: facets of its cells that belong to one cell alone, straight between all their
/// nodes. Of a body that has none: the facets of a port that encloses something, or else of
/// the one with most facets.
BodyHull hull_of(const Description& body, const Grid& grid);

/// Puts the hull where its points have gone: `displacement` [m] (nodes of the grid, 3), or (n, dim)
/// of the port; empty: to the reference.
void pose(BodyHull& hull, std::span<const double> displacement);

}  // namespace abut
