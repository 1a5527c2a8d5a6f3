// Rows of points that begin behind a partner's surface, or on it.

#include <algorithm>
#include <cmath>

#include "coordinator/passive/near_rows.hpp"

namespace abut {

namespace {

/// Of the shortest edge: roundings of places; less is on a surface.
constexpr double on_surface = 1.0e-6;
/// Of the thickness: a point that came out so far is out.
constexpr double out = 0.1;
/// A facet faces a point where its normal and the point's are apart by more than that: cosine.
constexpr double facing = -0.1;
/// Of how deep a point is behind a facet: one that is as far beside it is not behind it.
constexpr double beside = 0.5;

}  // namespace

void NearRows::begin(const Places& places) {
  behind_.assign(surfaces_.count(), 0);
  mark_behind(places, std::vector<std::uint8_t>(surfaces_.count(), 1));
}

void NearRows::accept(const Places& places) {
  if (behind_count_ == 0) return;
  const std::vector<std::uint8_t> before = behind_;
  mark_behind(places, before);
}

/// Points inside of a partner or on it, and those of edges that pass through facets.
void NearRows::mark_behind(const Places& places, const std::vector<std::uint8_t>& may_be) {
  const Skin& skin = surfaces_.skin();
  const double reach = surfaces_.shortest_edge();
  intersections(trees_, places, on_surface * reach, own_.others(), crossing_);
  trees_.refit(places, places);
  std::ranges::fill(behind_, 0);
  const bool first = std::ranges::all_of(may_be, [](std::uint8_t m) { return m != 0; });
  const double least = first ? on_surface * reach : out * thickness_;
  for (const std::int32_t node : skin.nodes) {
    if (may_be[node] == 0) continue;
    for (int group = 0; group < skin.groups && behind_[node] == 0; ++group) {
      if (!own_.others().allows(skin.group[node], group, skin.groups)) continue;
      if (skin.group[node] == group) continue;
      const std::int32_t facet = trees_.closest_facet(group, places, places[node], reach);
      if (facet < 0) continue;
      const SignedSide side = sides_.side(places, places[node], std::span(&facet, 1));
      const bool inside = side.gap < least && !(side.border && side.gap > on_surface * reach);
      if (inside) behind_[node] = 1;
    }
  }
  for (const Intersection& found : crossing_) {
    const auto mark = [&](std::int32_t point) {
      if (point >= 0 && may_be[point] != 0) behind_[point] = 1;
    };
    if (skin.dim == 2)
      for (const std::int32_t point : skin.facets[found.edge]) mark(point);
    else
      for (const std::int32_t point : skin.edges[found.edge]) mark(point);
    for (const std::int32_t point : skin.facets[found.facet]) mark(point);
  }
  behind_count_ = static_cast<int>(std::ranges::count(behind_, 1));
}

void NearRows::add_behind(const Places& from, std::vector<DistanceRow>& rows) {
  const Skin& skin = surfaces_.skin();
  around_.resize(surfaces_.count());
  for (std::vector<std::int32_t>& facets : around_) facets.clear();
  trees_.refit(from, from);
  for (int a = 0; a < skin.groups; ++a)
    for (int b = 0; b < skin.groups; ++b)
      if (a != b && own_.others().allows(a, b, skin.groups))
        trees_.visit(SkinTrees::nodes, a, SkinTrees::facets, b, surfaces_.shortest_edge(),
                     [&](std::int32_t node, std::int32_t facet) {
                       const std::int32_t point = skin.nodes[node];
                       if (behind_[point] != 0) around_[point].push_back(facet);
                     });
  for (const std::int32_t node : skin.nodes)
    if (!around_[node].empty()) add_facing(node, from, rows);
}

/// Along the normal of the nearest facet that faces the point.
void NearRows::add_facing(std::int32_t node, const Places& from,
                          std::vector<DistanceRow>& rows) const {
  const Skin& skin = surfaces_.skin();
  const double rounding = on_surface * surfaces_.shortest_edge();
  const Eigen::Vector3d own = sides_.point_normal(from, node);
  std::vector<std::int32_t> facets = around_[node];
  std::ranges::sort(facets);
  DistanceRow best;
  double nearest = surfaces_.shortest_edge(), most = 0.0;
  for (const std::int32_t facet : facets) {
    const auto& f = skin.facets[facet];
    DistanceRow row;
    row.features = {FeatureKind::node_facet, {node, f[0], f[1], f[2]}};
    const FeaturePoints x = places(row.features, from);
    const FeatureDistance found = feature_distance(FeatureKind::node_facet, skin.dim, x);
    row.normal = sides_.facet_normal(from, facet);
    row.gap = row.normal.dot(found.difference(x));
    const double aside = (found.difference(x) - row.gap * row.normal).norm();
    const double against = own.dot(row.normal);
    if (against > facing || aside > std::max(rounding, beside * std::abs(row.gap))) continue;
    if (row.gap > thickness_ || found.distance > nearest + rounding) continue;
    if (found.distance > nearest - rounding && against >= most) continue;
    nearest = std::min(nearest, found.distance);
    most = against;
    row.weights = found.weights;
    best = row;
  }
  if (most == 0.0) return;
  best.behind = true;
  best.friction = surfaces_.friction(node, best.features.points[1]);
  best.find_tangents(skin.dim);
  rows.push_back(best);
}

}  // namespace abut
