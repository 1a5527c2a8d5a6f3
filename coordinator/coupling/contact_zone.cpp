#include "coordinator/coupling/contact_zone.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "coordinator/coupling/state_fields.hpp"
#include "surface/closest_point.hpp"

namespace abut {

namespace {

/// Facets around what is reached that a new zone takes in: rows reach over a facet of either side,
/// and it should hold for some windows.
constexpr double zone_margin = 3.0;

PosedSurface pose(const PortGeometry& surface, std::span<const double> moved,
                  std::vector<double>& to) {
  to = surface.points;
  for (std::size_t v = 0; v < to.size(); ++v) to[v] += moved[v];
  return posed(surface, to);
}

/// [m] that no point has gone farther than, from one place to another.
double way_between(std::span<const double> from, std::span<const double> to, int dim) {
  double most = 0.0;
  for (std::size_t v = 0; v < from.size(); ++v) most = std::max(most, std::abs(to[v] - from[v]));
  return most * std::sqrt(static_cast<double>(dim));
}

}  // namespace

/// Whether all that is pressed or within `reach` [m] is known to be in the zone.
bool ContactZone::holds(std::span<const double> k, std::span<const double> n,
                        std::span<const double> pressed, double reach) const {
  if (seen_k_.empty()) return false;
  const int dim = k_.dim;
  if (reach + way_between(seen_k_, k, dim) + way_between(seen_n_, n, dim) >= clear_) return false;
  for (std::size_t v = 0; v < pressed.size(); ++v) {
    if (pressed[v] != 0.0 &&
        !std::ranges::binary_search(points_, static_cast<std::int32_t>(v / index(dim))))
      return false;
  }
  return true;
}

void ContactZone::see(const Joint& joint, const Bodies& bodies, std::span<const double> k,
                      std::span<const double> n, std::span<const double> pressed, double way) {
  if (all_) return;
  const PortGeometry& own = bodies.port(joint.kinematic_side()).geometry;
  const PortGeometry& other = bodies.port(joint.neumann_side()).geometry;
  const double facet = std::max(own.spacing, other.spacing);
  const double reach = facet + way + margin_;
  if (holds(k, n, pressed, reach)) return;
  k_ = pose(own, k, pose_k_);
  n_ = pose(other, n, pose_n_);
  if (tree_.empty()) build(tree_, k_, 0.0);
  refit(tree_, k_, 0.0);
  const std::vector<std::int32_t> now = reached(reach, pressed);
  if (!std::ranges::includes(points_, now)) {
    points_ = around(now, zone_margin * facet);
    all_ = points_.size() == index(n_.node_count());
    if (all_) return points_.clear();
  }
  seen_k_.assign(k.begin(), k.end());
  seen_n_.assign(n.begin(), n.end());
  clear_ = clearance(reach + zone_margin * facet);
}

/// [m] from the kinematic side to the nearest point that is not in the zone; `most`: to look no
/// farther.
double ContactZone::clearance(double most) const {
  ClosestSearch search;
  search.reach = most;
  for (std::int32_t node = 0; node < n_.node_count(); ++node) {
    if (std::ranges::binary_search(points_, node)) continue;
    if (const auto foot = closest_point(k_, tree_, n_.point(node), search))
      search.reach = foot->at.distance;
  }
  return search.reach;
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

/// Points no farther than `reach` [m] from any of these. They lie in cells of that size, so that a
/// point looks at those of the cells around its own alone.
std::vector<std::int32_t> ContactZone::around(const std::vector<std::int32_t>& points,
                                              double reach) const {
  const double edge = 1.0001 * reach;  // rounding of places in it
  const auto cell_of = [edge](const Eigen::Vector3d& x) {
    std::array<std::int64_t, 3> cell{};
    for (std::size_t d = 0; d < 3; ++d)
      cell[d] = static_cast<std::int64_t>(std::floor(x(static_cast<Eigen::Index>(d)) / edge));
    return cell;
  };
  std::map<std::array<std::int64_t, 3>, std::vector<std::int32_t>> cells;
  for (const std::int32_t p : points) cells[cell_of(n_.point(p))].push_back(p);
  const auto beside = [&](const Eigen::Vector3d& x) {
    const std::array<std::int64_t, 3> own = cell_of(x);
    for (int k = 0; k < 27; ++k) {
      const auto found =
          cells.find({own[0] + k / 9 - 1, own[1] + k / 3 % 3 - 1, own[2] + k % 3 - 1});
      if (found != cells.end() && std::ranges::any_of(found->second, [&](std::int32_t p) {
            return (n_.point(p) - x).norm() <= reach;
          }))
        return true;
    }
    return false;
  };
  std::vector<std::int32_t> out;
  for (std::int32_t node = 0; node < n_.node_count(); ++node)
    if (beside(n_.point(node))) out.push_back(node);
  return out;
}

void ContactZone::state(Archive& archive) {
  archive.field("all", all_);
  field(archive, "zone", points_);
  archive.field("seen_k", seen_k_);
  archive.field("seen_n", seen_n_);
  archive.field("clear", clear_);
}

}  // namespace abut
