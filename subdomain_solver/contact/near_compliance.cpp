#include "subdomain_solver/contact/near_compliance.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"

namespace abut {

namespace {

/// Of the largest displacement: what is smaller than this is not near. Forces are found by the
/// whole compliance in the end; this decides how soon.
constexpr double near_enough = 1.0e-2;
constexpr int farthest_ring = 6;

}  // namespace

void NearCompliance::set_points(int points, int dim, const std::vector<std::int32_t>& facets,
                                const std::vector<std::int32_t>& offsets) {
  rings_of_.assign(1, PointRings(points, facets, offsets));
  dim_ = index(dim);
  known_ = nullptr;
}

bool NearCompliance::find(Compliance& give) {
  if (known_ == &give && version_ == give.version()) return near_;
  near_ = find_reach(give) && press(give);
  known_ = &give;
  version_ = give.version();
  return near_;
}

/// How far one point is felt: the first from the middle of the list on that moves. Whatever presses
/// now, it is the same one, so that forces depend on the state alone.
bool NearCompliance::find_reach(Compliance& give) {
  PointRings& rings = rings_of_.front();
  const Eigen::Index dim = static_cast<Eigen::Index>(dim_);
  double most = 0.0;
  std::int32_t middle = rings.count() / 2;
  for (; middle < rings.count(); ++middle) {
    force_.setZero(rings.count() * dim);
    force_.segment(middle * dim, dim).setOnes();
    if (!give.apply(force_, moved_)) return false;
    most = moved_.lpNorm<Eigen::Infinity>();
    if (most > 0.0) break;
  }
  if (!(most > 0.0)) return false;
  for (rings_ = 0; rings_ <= farthest_ring; ++rings_) {
    for (const std::int32_t p : rings.around(middle, rings_))
      moved_.segment(p * dim, dim).setZero();
    if (moved_.lpNorm<Eigen::Infinity>() <= near_enough * most) break;
  }
  rings_ = std::max(rings_, 1);
  return rings_ <= farthest_ring;
}

bool NearCompliance::press(Compliance& give) {
  PointRings& rings = rings_of_.front();
  const int points = rings.count();
  kernel_.patterns = kernel_.width = points * static_cast<int>(dim_);
  kernel_.band.dim = static_cast<int>(dim_);
  kernel_.band.offsets.assign(1, 0);
  kernel_.band.reached.clear();
  for (std::int32_t p = 0; p < points; ++p) {
    const std::span<const std::int32_t> reached = rings.around(p, rings_);
    kernel_.band.reached.insert(kernel_.band.reached.end(), reached.begin(), reached.end());
    kernel_.band.offsets.push_back(static_cast<std::int32_t>(kernel_.band.reached.size()));
  }
  kernel_.displacement.assign(kernel_.per_step(), 0.0);
  const std::vector<int> colours = rings.colours(rings_);
  const std::size_t count = points > 0 ? index(*std::ranges::max_element(colours)) + 1 : 0;
  std::vector<std::vector<std::int32_t>> pressed(count);
  for (std::int32_t p = 0; p < points; ++p) pressed[index(colours[index(p)])].push_back(p);
  for (std::size_t k = 0; k < pressed.size() * dim_; ++k) {
    const std::size_t along = k % dim_;
    force_.setZero();
    for (const std::int32_t p : pressed[k / dim_])
      force_(static_cast<Eigen::Index>(index(p) * dim_ + along)) = 1.0;
    if (!give.apply(force_, moved_)) return false;
    for (const std::int32_t p : pressed[k / dim_]) {
      double* to =
          &kernel_.displacement[(index(kernel_.band.offsets[index(p)]) * dim_ + along) * dim_];
      for (const std::int32_t q : kernel_.band.of(index(p))) {
        for (std::size_t d = 0; d < dim_; ++d)
          to[d] = moved_(static_cast<Eigen::Index>(index(q) * dim_ + d));
        to += dim_ * dim_;
      }
    }
  }
  return true;
}

}  // namespace abut
