#include "coordinator/coupling/contact_zone.hpp"

#include <algorithm>

#include "surface/closest_point.hpp"

namespace abut {

namespace {

/// Facets around what contact may reach in a window that a new zone takes in: it then holds for
/// some windows, and for as many more points to be asked for.
constexpr double margin = 3.0;

PosedSurface pose(const PortGeometry& surface, std::span<const double> moved,
                  std::vector<double>& to) {
  to = surface.points;
  for (std::size_t v = 0; v < to.size(); ++v) to[v] += moved[v];
  return {surface.dim, to, surface.facets, surface.offsets};
}

}  // namespace

void ContactZone::see(const Joint& joint, const Bodies& bodies, std::span<const double> k,
                      std::span<const double> n, double way) {
  if (all_) return;
  const PortGeometry& own = bodies.port(joint.kinematic_side()).geometry;
  const PortGeometry& other = bodies.port(joint.neumann_side()).geometry;
  k_ = pose(own, k, pose_k_);
  n_ = pose(other, n, pose_n_);
  if (tree_.empty()) build(tree_, k_, 0.0);
  refit(tree_, k_, 0.0);
  const double facet = std::max(own.spacing, other.spacing);
  const std::vector<std::int32_t> reached = near(facet + way + joint.margin);
  if (std::ranges::includes(points_, reached)) return;
  points_ = near((1.0 + margin) * facet + way + joint.margin);
  all_ = points_.size() == index(n_.node_count());
  if (all_) points_.clear();
}

std::vector<std::int32_t> ContactZone::near(double reach) const {
  ClosestSearch search;
  search.reach = reach;
  std::vector<std::int32_t> points;
  for (std::int32_t node = 0; node < n_.node_count(); ++node)
    if (closest_point(k_, tree_, n_.point(node), search)) points.push_back(node);
  return points;
}

}  // namespace abut
