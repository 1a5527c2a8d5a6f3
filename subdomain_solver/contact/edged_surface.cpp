#include "subdomain_solver/contact/edged_surface.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/index.hpp"
#include "surface/closest_point.hpp"
#include "surface/sharp_nodes.hpp"

namespace abut {

EdgedSurface::EdgedSurface(const PortGeometry& surface, double size, double seen_by) {
  const PosedSurface whole = posed(surface);
  if (edge_nodes(whole, seen_by).empty()) return;
  divided_ = divided(whole, parts_for(whole, size));
  const PosedSurface parts = pose_of(surface.points);
  sharp_ = edge_nodes(parts, seen_by);
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

bool EdgedSurface::is_near(std::span<const double> pose, const PosedSurface& other,
                           const BoxTree& tree, double reach) {
  if (sharp_.empty()) return false;
  const PosedSurface parts = pose_of(pose);
  ClosestSearch search;
  search.reach = reach;
  return std::ranges::any_of(sharp_, [&](std::int32_t node) {
    const std::optional<SurfacePoint> foot = closest_point(other, tree, parts.point(node), search);
    return foot && foot->at.feature == FacetFeature::inside;
  });
}

void EdgedSurface::join(std::span<const double> pose, const PosedSurface& other,
                        const BoxTree& tree, double way, const MeetingCorners& corners,
                        SurfaceRows& rows) {
  PosedSurface parts = pose_of(pose);
  parts.round = parts.round || other.round;  // a tool has no radius of its own
  options_.reach = longest_ + way;
  refit(tree_, parts, options_.reach);
  overlapping_pairs(tree_, tree, pairs_);
  std::erase_if(pairs_, [this, &corners](const FacetPair& pair) {
    return corners.drops({pair.n, pair.k / parts_});
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
