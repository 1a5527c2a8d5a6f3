#pragma once

#include <cstdint>
#include <vector>

#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// The cells of a mesh, numbered through its blocks, and which of them share a facet (the dual
/// graph). Neighbours of cell c are next[begin[c]] to next[begin[c + 1] - 1], ascending.
struct CellGraph {
  std::vector<std::int32_t> begin;  // (cells + 1)
  std::vector<std::int32_t> next;
  std::vector<Facet> facets;  // (next) the shared facet, as one of cell c

  int cells() const { return static_cast<int>(begin.size()) - 1; }
};

CellGraph cell_graph(const Mesh& mesh);

/// The pieces that hang together by facets: of every cell the number of its piece, counted from 0
/// in the order of their first cells. `part` (cells): only cells of one part hang together.
std::vector<int> pieces_of(const CellGraph& graph, const std::vector<int>& part);

}  // namespace abut
