#include "coordinator/split/cell_graph.hpp"

#include <algorithm>
#include <array>
#include <tuple>

#include "base/index.hpp"

namespace abut {

namespace {

/// A facet by its corners, and whose it is.
struct GraphPlace {
  std::array<std::int32_t, 4> corners;  // sorted; -1 in front where there are fewer
  std::int32_t cell;
  Facet facet;
};

std::vector<GraphPlace> places_of(const Mesh& mesh) {
  std::vector<GraphPlace> places;
  std::int32_t cell = 0;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    const CellBlock& block = mesh.blocks[b];
    const Element& element = *block.element;
    const std::size_t corners = index(element_named(element.facet_name).corner_count());
    for (std::int32_t own = 0; own < block.count(); ++own, ++cell) {
      const std::span<const std::int32_t> nodes = nodes_of(block, own);
      for (std::size_t f = 0; f < element.facets.size(); ++f) {
        GraphPlace place{{-1, -1, -1, -1},
                    cell,
                    {static_cast<std::int32_t>(b), own, static_cast<std::int32_t>(f)}};
        for (std::size_t a = 0; a < corners; ++a)
          place.corners[a] = nodes[element.facets[f][a]];
        std::ranges::sort(place.corners);
        places.push_back(place);
      }
    }
  }
  return places;
}

}  // namespace

CellGraph cell_graph(const Mesh& mesh) {
  std::vector<GraphPlace> places = places_of(mesh);
  std::ranges::sort(places, [](const GraphPlace& a, const GraphPlace& b) {
    return std::tie(a.corners, a.cell) < std::tie(b.corners, b.cell);
  });
  struct Link {
    std::int32_t cell, other;
    Facet facet;
  };
  std::vector<Link> links;
  for (std::size_t k = 1; k < places.size(); ++k) {
    const GraphPlace &one = places[k - 1], &other = places[k];
    if (one.corners != other.corners) continue;
    links.push_back({one.cell, other.cell, one.facet});
    links.push_back({other.cell, one.cell, other.facet});
  }
  std::ranges::sort(links, [](const Link& a, const Link& b) {
    return std::tie(a.cell, a.other) < std::tie(b.cell, b.other);
  });
  CellGraph graph;
  graph.begin.assign(index(mesh.cell_count()) + 1, 0);
  for (const Link& link : links) {
    ++graph.begin[index(link.cell) + 1];
    graph.next.push_back(link.other);
    graph.facets.push_back(link.facet);
  }
  for (std::size_t c = 1; c < graph.begin.size(); ++c) graph.begin[c] += graph.begin[c - 1];
  return graph;
}

std::vector<int> pieces_of(const CellGraph& graph, const std::vector<int>& part) {
  std::vector<int> piece(index(graph.cells()), -1);
  std::vector<std::size_t> reached;
  int count = 0;
  for (std::size_t first = 0; first < piece.size(); ++first) {
    if (piece[first] >= 0) continue;
    piece[first] = count;
    reached.assign(1, first);
    while (!reached.empty()) {
      const std::size_t cell = reached.back();
      reached.pop_back();
      for (std::int32_t k = graph.begin[cell]; k < graph.begin[cell + 1]; ++k) {
        const std::size_t other = index(graph.next[k]);
        if (piece[other] >= 0 || part[other] != part[cell]) continue;
        piece[other] = count;
        reached.push_back(other);
      }
    }
    ++count;
  }
  return piece;
}

}  // namespace abut
