#include "subdomain_solver/contact/edged_surface.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "base/index.hpp"
#include "base/one_each.hpp"
#include "surface/closest_point.hpp"
#include "surface/sharp_nodes.hpp"

namespace abut {

namespace {

/// Of the angle that a facet may have with what it lies along: half of a sharp edge's.
const double along = std::cos(0.5 * sharp_edge);

}  // namespace

EdgedSurface::EdgedSurface(const PortGeometry& surface, double size, double seen_by) {
  const PosedSurface whole = posed(surface);
  if (edge_nodes(whole, seen_by).empty()) return;
  divided_ = divided(whole, parts_for(whole, size));
  const PosedSurface parts = pose_of(surface.points);
  for (const SharpEdge& edge : sharp_edges(parts, sharp_edge))
    for (const std::int32_t end : edge.ends)
      for (const std::int32_t facet : edge.facets) sharp_.emplace_back(end, facet);
  keep_one_each(sharp_);
  std::ranges::set_difference(edge_nodes(parts, seen_by), sharp_nodes(parts, sharp_edge),
                              std::back_inserter(bent_));
  longest_ = longest_edge(parts);
  parts_ = parts.facet_count() / whole.facet_count();
  build(tree_, parts, 0.0);
  sum_.resize(whole.node_count());
}

PosedSurface EdgedSurface::pose_of(std::span<const double> pose) {
  points_.resize(index(divided_.node_count() * divided_.dim));
  apply(divided_.nodes, divided_.dim, pose, points_);
  return posed(divided_, points_);
}

EdgesNear EdgedSurface::near(std::span<const double> pose, const PosedSurface& other,
                             const BoxTree& tree, double reach) {
  EdgesNear found;
  if (!any()) return found;
  const PosedSurface parts = pose_of(pose);
  ClosestSearch search;
  search.reach = reach;
  const auto foot_of = [&](std::int32_t node) {
    const auto foot = closest_point(other, tree, parts.point(node), search);
    return foot && foot->at.feature == FacetFeature::inside ? foot : std::nullopt;
  };
  for (const std::int32_t node : bent_)
    if (const auto foot = foot_of(node)) found.bent = std::min(found.bent, foot->at.distance);
  for (auto at = sharp_.begin(); at != sharp_.end();) {
    const std::int32_t node = at->first;
    const auto next = std::find_if(at, sharp_.end(), [node](auto s) { return s.first != node; });
    if (const auto foot = foot_of(node)) {
      found.sharp = std::min(found.sharp, foot->at.distance);
      const Eigen::Vector3d normal = mean_normal(corners(other, foot->facet));
      if (std::none_of(at, next, [&](const auto& s) {
            return mean_normal(corners(parts, s.second)).dot(normal) < -along;
          }))
        found.leaning = std::min(found.leaning, foot->at.distance);
    }
    at = next;
  }
  return found;
}

void EdgedSurface::join(std::span<const double> pose, const PosedSurface& other,
                        const BoxTree& tree, double way, const Drops& drops, SurfaceRows& rows) {
  PosedSurface parts = pose_of(pose);
  parts.round = parts.round || other.round;  // a tool has no radius of its own
  options_.reach = longest_ + way;
  refit(tree_, parts, options_.reach);
  overlapping_pairs(tree_, tree, pairs_);
  std::erase_if(pairs_, [this, &drops](const FacetPair& pair) {
    return drops({pair.n, pair.k / parts_});
  });
  mortar_rows(parts, other, pairs_, options_, buffers_, rows);
  mapped_.clear();
  for (int r = 0; r < rows.count(); ++r) {
    for (std::int32_t e = rows.k.offsets[r]; e < rows.k.offsets[index(r) + 1]; ++e) {
      const std::size_t node = index(rows.k.columns[e]);
      const double share = rows.k.values[e];
      for (std::int32_t i = divided_.nodes.offsets[node]; i < divided_.nodes.offsets[node + 1]; ++i)
        sum_.add(divided_.nodes.columns[i], share * divided_.nodes.values[i]);
    }
    sum_.flush(1.0, mapped_);
  }
  std::swap(rows.k, rows.n);
  std::swap(rows.n, mapped_);
  for (int r = 0; r < rows.count(); ++r) {
    const auto first = rows.k.values.begin() + rows.k.offsets[r];
    const auto most = std::max_element(first, rows.k.values.begin() + rows.k.offsets[index(r) + 1]);
    rows.nodes[r] = rows.k.columns[most - rows.k.values.begin()];
  }
  for (double& component : rows.normals) component = -component;
}

}  // namespace abut
