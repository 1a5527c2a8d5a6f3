#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "surface/mortar_pieces.hpp"
#include "surface/posed_surface.hpp"
#include "surface/surface_rows.hpp"

namespace abut {

/// One row while it is summed up: dense over the nodes, with a list of those in use.
struct RowSum {
  std::vector<double> values;         // (nodes)
  std::vector<char> used;             // (nodes)
  std::vector<std::int32_t> columns;  // in use

  void resize(int nodes);
  void add(std::int32_t column, double value);
  /// Appends sum / weight to `rows` and begins anew.
  void flush(double weight, SparseRows& rows);
};

struct RowBuffers {
  std::vector<std::int32_t> begin;  // (nodes of K + 1) where the parts of a row begin
  struct Part {
    std::int32_t facet, corner;  // of pieces.facets; of that facet
  };
  std::vector<Part> parts;
  RowSum k, n;
};

/// Sums up pieces into rows. `root` says which row a node of K belongs to (merged_rows).
void assemble_rows(const PosedSurface& k, const PosedSurface& n, const MortarPieces& pieces,
                   std::span<const std::int32_t> root, RowBuffers& buffers, SurfaceRows& rows);

}  // namespace abut
