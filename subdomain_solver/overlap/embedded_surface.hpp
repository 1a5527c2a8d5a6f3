#pragma once

#include <cstdint>
#include <vector>

#include "contract/port.hpp"
#include "surface/sparse_rows.hpp"

namespace abut {

/// The boundary of another body, where it lies inside this one, in parts of facets, each in one
/// cell: their corners move so that between them is, in the mean, what the cell does there [M.113].
/// Quadrilaterals that lie in one cell as a whole are one part.
/// Points without facets come last, and are compared one by one with those of the other body.
struct EmbeddedSurface {
  std::vector<double> points;                 // [m] (n, dim)
  std::vector<std::int32_t> facets, offsets;  // as of a surface of this body, its sense turned
  SparseRows rows;                            // (n) over the nodes of this body's mesh

  int count() const { return rows.count(); }
};

/// Adds these points and facets to those of a port's own side.
void add_to(const EmbeddedSurface& inside, PortGeometry& port);

}  // namespace abut
