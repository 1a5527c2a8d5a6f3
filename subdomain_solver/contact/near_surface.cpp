#include "subdomain_solver/contact/near_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/index.hpp"

namespace abut {

namespace {

double largest_move(std::span<const double> a, std::span<const double> b) {
  double most = 0.0;
  for (std::size_t v = 0; v < a.size(); ++v) most = std::max(most, std::abs(a[v] - b[v]));
  return most;
}

}  // namespace

NearSurface::NearSurface(const PortGeometry& whole, const PortGeometry& own)
    : dim(whole.dim),
      round(whole.round),
      whole_(&whole),
      own_(&own),
      made_(whole.points.size(), 0.0) {
  build(tree_, posed(whole), 0.0);
  build(own_tree_, posed(own), 0.0);
  posed_ = true;
}

void NearSurface::follow(std::span<const double> u) {
  const std::size_t width = made_.size();
  u_ = u;
  moved_ = 0.0;
  stands_ = true;
  for (std::size_t first = 0; first < u.size(); first += width) {
    const std::span<const double> level = u.subspan(first, width);
    moved_ = std::max(moved_, largest_move(level, made_));
    stands_ = stands_ && (first == 0 || std::ranges::equal(level, u.first(width)));
  }
}

bool NearSurface::holds(std::span<const double> pose, double reach) const {
  return all_ || reach + moved_ + (margin_ < 0.0 ? 0.0 : largest_move(pose, made_own_)) <= margin_;
}

void NearSurface::take_all() {
  if (all_) return;
  all_ = true;
  points = whole_->points;
  facets = whole_->facets;
  offsets = whole_->offsets;
  listed_.clear();
  list_values();
}

void NearSurface::find(std::span<const double> pose, double reach,
                       const std::vector<std::int32_t>& needed, bool grows) {
  if (all_) return;
  const std::span<const double> begin = u_.first(made_.size());
  if (!std::ranges::equal(begin, made_)) {
    made_.assign(begin.begin(), begin.end());
    posed_ = false;
    follow(u_);
  }
  const PosedSurface own = posed(*own_, pose);
  if (!posed_) {
    pose_ = whole_->points;
    for (std::size_t v = 0; v < pose_.size(); ++v) pose_[v] += made_[v];
    refit(tree_, posed(*whole_, pose_), 0.0);
    posed_ = true;
  }
  made_own_.assign(pose.begin(), pose.end());
  margin_ = 2.0 * (reach + moved_);
  refit(own_tree_, own, margin_);
  overlapping_pairs(own_tree_, tree_, pairs_);
  std::vector<char> has(index(posed(*whole_).facet_count()), 0);
  for (const FacetPair& pair : pairs_) has[pair.n] = 1;
  if (grows)
    for (const std::int32_t facet : taken_) has[facet] = 1;
  if (!needed.empty()) {
    for (std::size_t f = 0; f < has.size(); ++f)
      for (const std::int32_t node : posed(*whole_).nodes(static_cast<int>(f)))
        if (std::ranges::binary_search(needed, node)) has[f] = 1;
  }
  number(has);
}

/// Points in the order of the whole, so that nothing that is summed up over them is in another.
void NearSurface::number(const std::vector<char>& has) {
  const PosedSurface whole = posed(*whole_);
  taken_.clear();
  part_of_.assign(index(whole.node_count()), -1);
  part_of_[0] = 0;  // one at least: no list stands for all
  for (std::size_t f = 0; f < has.size(); ++f) {
    if (has[f] == 0) continue;
    taken_.push_back(static_cast<std::int32_t>(f));
    for (const std::int32_t node : whole.nodes(static_cast<int>(f))) part_of_[node] = 0;
  }
  if (taken_.size() == has.size()) return take_all();
  listed_.clear();
  points.clear();
  for (std::int32_t node = 0; node < whole.node_count(); ++node) {
    if (part_of_[node] < 0) continue;
    part_of_[node] = static_cast<std::int32_t>(listed_.size());
    listed_.push_back(node);
    const std::size_t first = index(node) * index(dim);
    for (std::size_t i = 0; i < index(dim); ++i) points.push_back(whole_->points[first + i]);
  }
  facets.clear();
  offsets.assign(1, 0);
  for (const std::int32_t facet : taken_) {
    for (const std::int32_t node : whole.nodes(facet)) facets.push_back(part_of_[node]);
    offsets.push_back(static_cast<std::int32_t>(facets.size()));
  }
  list_values();
}

void NearSurface::list_values() {
  values_.resize(points.size());
  const std::size_t n = index(dim);
  for (std::size_t v = 0; v < values_.size(); ++v)
    values_[v] = index(in_whole(static_cast<std::int32_t>(v / n))) * n + v % n;
}

}  // namespace abut
