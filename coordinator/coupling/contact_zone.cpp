#include "coordinator/coupling/contact_zone.hpp"

#include <algorithm>

#include "surface/closest_point.hpp"

namespace abut {

namespace {

/// Facets around what is reached that a new zone takes in: rows reach over a facet of either side,
/// and it should hold for some windows.
constexpr double margin = 3.0;

PosedSurface pose(const PortGeometry& surface, std::span<const double> moved,
                  std::vector<double>& to) {
  to = surface.points;
  for (std::size_t v = 0; v < to.size(); ++v) to[v] += moved[v];
  return posed(surface, to);
}

}  // namespace

void ContactZone::see(const Joint& joint, const Bodies& bodies, std::span<const double> k,
                      std::span<const double> n, std::span<const double> pressed, double way) {
  if (all_) return;
  const PortGeometry& own = bodies.port(joint.kinematic_side()).geometry;
  const PortGeometry& other = bodies.port(joint.neumann_side()).geometry;
  k_ = pose(own, k, pose_k_);
  n_ = pose(other, n, pose_n_);
  if (tree_.empty()) build(tree_, k_, 0.0);
  refit(tree_, k_, 0.0);
  const double facet = std::max(own.spacing, other.spacing);
  const std::vector<std::int32_t> now = reached(facet + way + joint.margin, pressed);
  if (std::ranges::includes(points_, now)) return;
  points_ = around(now, margin * facet);
  all_ = points_.size() == index(n_.node_count());
  if (all_) points_.clear();
}

std::vector<std::int32_t> ContactZone::reached(double reach,
                                               std::span<const double> pressed) const {
  const std::size_t dim = index(n_.dim);
  ClosestSearch search;
  search.reach = reach;
  std::vector<std::int32_t> points;
  for (std::int32_t node = 0; node < n_.node_count(); ++node) {
    const std::span<const double> force = pressed.subspan(index(node) * dim, dim);
    if (std::ranges::any_of(force, [](double f) { return f != 0.0; }) ||
        closest_point(k_, tree_, n_.point(node), search))
      points.push_back(node);
  }
  return points;
}

/// Points no farther than `reach` [m] from any of these.
std::vector<std::int32_t> ContactZone::around(const std::vector<std::int32_t>& points,
                                              double reach) const {
  std::vector<std::int32_t> out;
  for (std::int32_t node = 0; node < n_.node_count(); ++node) {
    const Eigen::Vector3d x = n_.point(node);
    const auto beside = [&](std::int32_t p) { return (n_.point(p) - x).norm() <= reach; };
    if (std::ranges::any_of(points, beside)) out.push_back(node);
  }
  return out;
}

}  // namespace abut
