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

namespace {

NearestPoint nearest_point(const Eigen::Vector3d& place, const PosedSurface& other,
                           const BoxTree& tree) {
  const std::optional<SurfacePoint> found = closest_point(other, tree, place);
  if (!found) return {NearestPoint::none, place};
  return {found->facet, found->at.point};
}

/// `nearest()` gives what of `other` is nearest to the place: a search, which most places need not.
template <typename Nearest>
bool sees_through(const Eigen::Vector3d& place, const PosedSurface& other, int facet, double depth,
                  const Nearest& nearest) {
  const Corners seen = corners(other, facet);
  const Eigen::Vector3d out = mean_normal(seen), on = centre(seen);
  const double height = out.dot(place - on);
  if (!(height < -depth)) return false;
  const NearestPoint& found = nearest();
  if (found.facet == NearestPoint::none) return false;
  const Eigen::Vector3d way = place - found.point;
  const bool inside = way.dot(mean_normal(corners(other, found.facet))) <= 0.0;
  const double between = out.dot(found.point - on);
  return !inside && between < -depth && between > height + depth;
}

}  // namespace

bool sees_through(const Eigen::Vector3d& place, const PosedSurface& other, const BoxTree& tree,
                  int facet, double depth) {
  return sees_through(place, other, facet, depth,
                      [&] { return nearest_point(place, other, tree); });
}

void FarSides::leave_out(const PosedSurface& k, const PosedSurface& n, double depth,
                         std::vector<FacetPair>& pairs) {
  const auto deep = [&](const FacetPair& pair) { return is_behind(k, n, pair, depth); };
  dropped_.clear();
  if (std::ranges::none_of(pairs, deep)) return;
  build(k_tree_, k, 0.0);
  build(n_tree_, n, 0.0);
  of_k_.assign(k.facet_count(), {});
  of_n_.assign(n.facet_count(), {});
  // a facet is in many pairs, and what is nearest to its middle is the same in all of them
  const auto middle_sees = [depth](const PosedSurface& from, int facet, const PosedSurface& other,
                                   const BoxTree& tree, int seen, NearestPoint& nearest) {
    const Eigen::Vector3d place = centre(corners(from, facet));
    return sees_through(place, other, seen, depth, [&]() -> const NearestPoint& {
      if (nearest.facet == NearestPoint::unknown) nearest = nearest_point(place, other, tree);
      return nearest;
    });
  };
  std::ranges::copy_if(pairs, std::back_inserter(dropped_), [&](const FacetPair& pair) {
    return deep(pair) && (middle_sees(k, pair.k, n, n_tree_, pair.n, of_k_[pair.k]) ||
                          middle_sees(n, pair.n, k, k_tree_, pair.k, of_n_[pair.n]));
  });
  std::erase_if(pairs, [this](const FacetPair& pair) { return drops(pair); });
}

}  // namespace abut
