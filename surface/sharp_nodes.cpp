#include "surface/sharp_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstddef>
#include <span>

#include "base/one_each.hpp"

namespace abut {
namespace {

/// One facet's part in an edge: its nodes ascending. In the plane an edge is a node, named twice.
struct HalfEdge {
  std::int32_t a, b, facet;

  auto operator<=>(const HalfEdge&) const = default;
  bool same_edge(const HalfEdge& other) const { return a == other.a && b == other.b; }
};

std::vector<HalfEdge> sorted_edges(const PosedSurface& surface) {
  std::vector<HalfEdge> edges;
  for (std::int32_t f = 0; f < surface.facet_count(); ++f) {
    const std::span<const std::int32_t> nodes = surface.nodes(f);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::int32_t a = nodes[i];
      const std::int32_t b = surface.dim == 2 ? a : nodes[(i + 1) % nodes.size()];
      edges.push_back({std::min(a, b), std::max(a, b), f});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

std::vector<std::int32_t> ends_of(const std::vector<SharpEdge>& edges) {
  std::vector<std::int32_t> nodes;
  for (const SharpEdge& edge : edges) nodes.insert(nodes.end(), edge.ends.begin(), edge.ends.end());
  keep_one_each(nodes);
  return nodes;
}

}  // namespace

std::vector<SharpEdge> sharp_edges(const PosedSurface& surface, double angle, double length) {
  const std::vector<HalfEdge> edges = sorted_edges(surface);
  const double limit = std::cos(angle);
  std::vector<SharpEdge> sharp;
  for (std::size_t i = 1; i < edges.size(); ++i) {
    if (!edges[i].same_edge(edges[i - 1])) continue;
    const Corners one = corners(surface, edges[i - 1].facet);
    const Corners other = corners(surface, edges[i].facet);
    const Eigen::Vector3d n = mean_normal(one), m = mean_normal(other);
    const Eigen::Vector3d way = centre(other) - centre(one);
    const double turn = std::atan2(n.cross(m).norm(), n.dot(m));
    if (n.dot(way) < 0.0 && (n.dot(m) < limit || turn * length > angle * way.norm()))
      sharp.push_back({{edges[i].a, edges[i].b}, {edges[i - 1].facet, edges[i].facet}});
  }
  return sharp;
}

std::vector<std::int32_t> sharp_nodes(const PosedSurface& surface, double angle) {
  return ends_of(sharp_edges(surface, angle));
}

std::vector<std::int32_t> edge_nodes(const PosedSurface& surface, double size) {
  return ends_of(sharp_edges(surface, sharp_edge, 2.0 * size));
}

}  // namespace abut
