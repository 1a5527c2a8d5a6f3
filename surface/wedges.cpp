#include "surface/wedges.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/one_each.hpp"

namespace abut {
namespace {

/// Cosine between edges that are one straight edge.
const double straight = std::cos(std::numbers::pi / 18.0);

void sort_unique(std::vector<std::int32_t>& numbers) { keep_one_each(numbers); }

std::int32_t other_end(const SharpEdge& edge, std::int32_t node) {
  return edge.ends[edge.ends[0] == node ? 1 : 0];
}

/// Whether edges of nodes a, b and b, c are one.
bool is_straight(const PosedSurface& s, std::int32_t a, std::int32_t b, std::int32_t c) {
  const Eigen::Vector3d one = s.point(b) - s.point(a), two = s.point(c) - s.point(b);
  return one.dot(two) >= straight * one.norm() * two.norm();
}

}  // namespace

Wedges::Wedges(const PosedSurface& surface) {
  const std::vector<SharpEdge> edges = sharp_edges(surface, sharp_edge);
  if (edges.empty()) return;
  std::vector<std::vector<std::int32_t>> edges_at(index(surface.node_count())), facets_at(edges_at);
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (const std::int32_t a : edges[e].ends) edges_at[a].push_back(static_cast<std::int32_t>(e));
  for (int f = 0; f < surface.facet_count(); ++f)
    for (const std::int32_t a : surface.nodes(f)) facets_at[a].push_back(f);
  for (const SharpEdge& edge : edges) {
    Wedge wedge{edge, {edge.facets.begin(), edge.facets.end()}, {}, {edge.ends}, {-1, -1}};
    for (std::size_t end = 0; end < 2; ++end) {
      const std::int32_t a = edge.ends[end], from = edge.ends[1 - end];
      if (surface.dim == 3 && edges_at[a].size() == 2)
        for (const std::int32_t e : edges_at[a]) {
          const std::int32_t to = other_end(edges[e], a);
          if (to != from && is_straight(surface, from, a, to)) wedge.beyond[end] = to;
        }
      if (surface.dim == 2 || edges_at[a].size() < 3) continue;
      const std::vector<std::int32_t>& more = facets_at[a];
      wedge.planes.insert(wedge.planes.end(), more.begin(), more.end());
      for (const std::int32_t e : edges_at[a])
        if (edges[e].ends != edge.ends) wedge.edges.push_back(edges[e].ends);
    }
    sort_unique(wedge.planes);
    for (const std::int32_t f : wedge.planes)
      wedge.nodes.insert(wedge.nodes.end(), surface.nodes(f).begin(), surface.nodes(f).end());
    sort_unique(wedge.nodes);
    all_.push_back(std::move(wedge));
  }
  for (int f = 0; f < surface.facet_count(); ++f) {
    std::vector<std::int32_t> touched;
    for (const std::int32_t a : surface.nodes(f))
      touched.insert(touched.end(), edges_at[a].begin(), edges_at[a].end());
    at_.add(std::move(touched));
  }
  for (int f = 0; f < surface.facet_count(); ++f) {
    std::vector<std::int32_t> near;
    for (const std::int32_t a : surface.nodes(f))
      for (const std::int32_t g : facets_at[a]) near.insert(near.end(), at(g).begin(), at(g).end());
    around_.add(std::move(near));
  }
}

void Wedges::Lists::add(std::vector<std::int32_t> list) {
  sort_unique(list);
  numbers.insert(numbers.end(), list.begin(), list.end());
  offsets.push_back(static_cast<std::int32_t>(numbers.size()));
}

}  // namespace abut
