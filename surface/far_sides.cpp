#include "surface/far_sides.hpp"

#include <algorithm>
#include <iterator>
#include <optional>

#include "surface/closest_point.hpp"
#include "surface/plane_facet.hpp"

namespace abut {

bool is_behind(const PosedSurface& k, const PosedSurface& n, const FacetPair& pair, double depth) {
  const Corners seen = corners(n, pair.n);
  return mean_normal(seen).dot(centre(corners(k, pair.k)) - centre(seen)) < -depth;
}

bool sees_through(const Eigen::Vector3d& place, const PosedSurface& other, const BoxTree& tree,
                  int facet, double depth) {
  const Corners seen = corners(other, facet);
  const Eigen::Vector3d out = mean_normal(seen), on = centre(seen);
  const double height = out.dot(place - on);
  if (!(height < -depth)) return false;
  const std::optional<SurfacePoint> nearest = closest_point(other, tree, place);
  if (!nearest) return false;
  const Eigen::Vector3d way = place - nearest->at.point;
  const bool inside = way.dot(mean_normal(corners(other, nearest->facet))) <= 0.0;
  const double between = out.dot(nearest->at.point - on);
  return !inside && between < -depth && between > height + depth;
}

void FarSides::leave_out(const PosedSurface& k, const PosedSurface& n, double depth,
                         std::vector<FacetPair>& pairs) {
  const auto deep = [&](const FacetPair& pair) { return is_behind(k, n, pair, depth); };
  dropped_.clear();
  if (std::ranges::none_of(pairs, deep)) return;
  build(k_tree_, k, 0.0);
  build(n_tree_, n, 0.0);
  std::ranges::copy_if(pairs, std::back_inserter(dropped_), [&](const FacetPair& pair) {
    if (!deep(pair)) return false;
    return sees_through(centre(corners(k, pair.k)), n, n_tree_, pair.n, depth) ||
           sees_through(centre(corners(n, pair.n)), k, k_tree_, pair.k, depth);
  });
  std::erase_if(pairs, [this](const FacetPair& pair) { return drops(pair); });
}

}  // namespace abut
