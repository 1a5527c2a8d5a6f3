#include "surface/meeting_corners.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/index.hpp"
#include "base/one_each.hpp"
#include "surface/clip.hpp"
#include "surface/plane_facet.hpp"

namespace abut {
namespace {

constexpr double degrees = std::numbers::pi / 180.0;
/// Cosines: facets that lie along a plane, and those that are averaged over along a plane of N's.
const double same_direction = std::cos(10.0 * degrees), along = std::cos(35.0 * degrees);

// Of a facet's size: planes that separate worse by less than `round` share the normal. Wedges that
// overlap by more than `deep` are not of this side. Differences of `corner_rounding` choose no
// plane.
constexpr double round = 0.02, deep = 0.25, corner_rounding = 1.0e-9;

/// Of a facet: what covers less only touches it.
constexpr double touching = 1.0e-6;

/// Squared sine between edges that tell no plane: what runs along each other.
constexpr double parallel = 0.01;

double size_of(const PosedSurface& surface, const Wedge& wedge) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::int32_t f : wedge.facets) {
    const Corners facet = corners(surface, f);
    least = std::min(least, facet.count == 2 ? area(facet) : std::sqrt(area(facet)));
  }
  return least;
}

Eigen::Vector3d normal_of(const PosedSurface& surface, std::int32_t facet) {
  return mean_normal(corners(surface, facet));
}

Eigen::Vector3d along_edge(const PosedSurface& surface, const std::array<std::int32_t, 2>& ends) {
  return surface.point(ends[1]) - surface.point(ends[0]);
}

/// Whether facets cover each other, seen along the normal of the first, by more than rounding.
bool cover(const Corners& one, const Corners& other) {
  const AuxiliaryPlane plane = auxiliary_plane(one);
  const PlaneFacet own = seen_in(plane, one), its = seen_in(plane, other);
  const double least = touching * area(one);
  if (one.count > 2) return signed_area(clip(its.polygon(), own.polygon())) > least;
  const auto part = [](const PlaneFacet& f) {
    return Interval{std::min(f.x[0].x(), f.x[1].x()), std::max(f.x[0].x(), f.x[1].x())};
  };
  return clip(part(own), part(its)).length() > least;
}

bool has(const Wedge& wedge, std::int32_t facet) {
  return std::ranges::find(wedge.facets, facet) != wedge.facets.end();
}

}  // namespace

void MeetingCorners::find(const CornerSurface& k, const CornerSurface& n,
                          std::span<const FacetPair> pairs, const CornerOptions& options) {
  verdicts_.clear();
  dropped_.clear();
  rows_.clear();
  if (!k.wedges->any() || !n.wedges->any()) return;
  k_ = k;
  n_ = n;
  options_ = options;
  find_verdicts(pairs);
  if (verdicts_.empty()) return;
  crosses_ = std::ranges::any_of(verdicts_, &Verdict::crosses);
  k_now_.clear(k_.now);
  n_now_.clear(n_.now);
  for (const FacetPair& pair : pairs)
    if (is_dropped(pair)) dropped_.push_back(pair);
}

bool MeetingCorners::drops(FacetPair pair) const {
  return std::ranges::binary_search(dropped_, pair);
}

/// Of all wedges of which facets are pairs.
void MeetingCorners::find_verdicts(std::span<const FacetPair> pairs) {
  for (const FacetPair& pair : pairs)
    for (const std::int32_t one : k_.wedges->at(pair.k)) {
      if (!has((*k_.wedges)[one], pair.k)) continue;
      for (const std::int32_t two : n_.wedges->at(pair.n))
        if (has((*n_.wedges)[two], pair.n)) verdicts_.push_back({.k = one, .n = two});
    }
  keep_one_each(verdicts_, wedges);
  recall_found();
  for (Verdict& verdict : verdicts_) judge(verdict);
  begins_.assign(index(k_.wedges->count()) + 1, 0);
  for (const Verdict& verdict : verdicts_) ++begins_[index(verdict.k) + 1];
  std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
}

/// Of other places nothing is known. Where a substep began is the same for all looks at its end.
void MeetingCorners::recall_found() {
  const bool same = k_wedges_ == k_.wedges && n_wedges_ == n_.wedges &&
                    std::ranges::equal(k_places_, k_.before.points) &&
                    std::ranges::equal(n_places_, n_.before.points);
  if (same) {
    std::ranges::sort(found_, {}, [](const Found& f) { return std::pair(f.k, f.n); });
    ordered_ = found_.size();
    return;
  }
  k_wedges_ = k_.wedges;
  n_wedges_ = n_.wedges;
  k_places_.assign(k_.before.points.begin(), k_.before.points.end());
  n_places_.assign(n_.before.points.begin(), n_.before.points.end());
  k_before_.clear(k_.before);
  n_before_.clear(n_.before);
  found_.clear();
  kept_.clear();
  ordered_ = 0;
}

/// Those of facets, unless they are known.
std::size_t MeetingCorners::find_planes(std::int32_t one, std::int32_t two) {
  const auto known = std::span(found_).first(ordered_);
  const auto at = std::ranges::lower_bound(known, std::pair(one, two), {},
                                           [](const Found& f) { return std::pair(f.k, f.n); });
  if (at != known.end() && at->k == one && at->n == two) return index(at - known.begin());
  ++searches_;
  look_at_facets((*k_.wedges)[one], (*n_.wedges)[two]);
  found_.push_back({.k = one, .n = two, .size = size_, .of_facets = most_});
  return found_.size() - 1;
}

/// All of them, to planes_.
void MeetingCorners::find_all_planes(const Verdict& verdict) {
  Found& found = found_[verdict.found];
  if (!found.whole) {
    const Wedge &a = (*k_.wedges)[verdict.k], &b = (*n_.wedges)[verdict.n];
    look_at_facets(a, b);
    for (const Ends& one : a.edges)
      for (const Ends& two : b.edges) look_across(one, two);
    found.whole = true;
    found.most = most_;
    found.first = kept_.size();
    found.count = planes_.size();
    kept_.insert(kept_.end(), planes_.begin(), planes_.end());
    return;
  }
  const auto planes = std::span(kept_).subspan(found.first, found.count);
  planes_.assign(planes.begin(), planes.end());
  most_ = found.most;
  size_ = found.size;
}

std::span<MeetingCorners::Verdict> MeetingCorners::verdicts_of(std::int32_t k) {
  const std::size_t from = begins_[index(k)], to = begins_[index(k) + 1];
  return std::span(verdicts_).subspan(from, to - from);
}

void MeetingCorners::Extent::set(const PosedSurface& surface, const Wedge& wedge) {
  points.clear();
  for (const std::int32_t node : wedge.nodes) points.push_back(surface.point(node));
  edge = along_edge(surface, wedge.ends);
  beyond = {wedge.beyond[0] >= 0, wedge.beyond[1] >= 0};
}

/// Edges that go on straight beyond their wedge do so by another length of it.
std::array<double, 2> MeetingCorners::Extent::along(const Eigen::Vector3d& normal) const {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Eigen::Vector3d& x : points) {
    const double at = normal.dot(x);
    low = std::min(low, at);
    high = std::max(high, at);
  }
  const double up = normal.dot(edge);
  low -= std::max({0.0, beyond[0] ? up : 0.0, beyond[1] ? -up : 0.0});
  high += std::max({0.0, beyond[0] ? -up : 0.0, beyond[1] ? up : 0.0});
  return {low, high};
}

/// Whether it has points less than `far` [m] before a plane, and points less than that behind it.
bool MeetingCorners::Extent::is_on_both_sides(const Eigen::Vector3d& normal, double plane,
                                              double far) const {
  bool below = false, above = false;
  for (const Eigen::Vector3d& x : points) {
    const double at = normal.dot(x) - plane;
    below = below || at < far;
    above = above || -at < far;
    if (below && above) return true;
  }
  return false;
}

void MeetingCorners::Normals::clear(const PosedSurface& surface) {
  of.resize(index(surface.facet_count()));
  known.assign(of.size(), 0);
}

const Eigen::Vector3d& MeetingCorners::Normals::at(const PosedSurface& surface,
                                                   std::int32_t facet) {
  if (std::exchange(known[facet], 1) == 0) of[facet] = normal_of(surface, facet);
  return of[facet];
}

void MeetingCorners::look_at_facets(const Wedge& a, const Wedge& b) {
  size_ = std::min(size_of(k_.before, a), size_of(n_.before, b));
  k_extent_.set(k_.before, a);
  n_extent_.set(n_.before, b);
  planes_.clear();
  most_ = -std::numeric_limits<double>::infinity();
  for (const std::int32_t f : b.planes)
    look_along({Kind::n_plane, f, {}, {}, 1.0, n_before_.at(n_.before, f), 0.0});
  for (const std::int32_t f : a.planes)
    look_along({Kind::k_plane, f, {}, {}, 1.0, -k_before_.at(k_.before, f), 0.0});
}

void MeetingCorners::look_along(Plane plane) {
  plane.apart = k_extent_.along(plane.normal)[0] - n_extent_.along(plane.normal)[1];
  keep(plane);
}

void MeetingCorners::look_across(const Ends& one, const Ends& two) {
  const Eigen::Vector3d u = along_edge(k_.before, one), v = along_edge(n_.before, two);
  const Eigen::Vector3d across = u.cross(v);
  if (!(across.squaredNorm() > parallel * u.squaredNorm() * v.squaredNorm())) return;
  const Eigen::Vector3d normal = across.normalized();
  // Nearly all fall behind by a few points already.
  const double on = normal.dot(n_.before.point(two[0]));
  if (k_extent_.is_on_both_sides(normal, on, worst())) return;
  const std::array<double, 2> k = k_extent_.along(normal), n = n_extent_.along(normal);
  keep({Kind::edges, -1, one, two, 1.0, normal, k[0] - n[1]});
  keep({Kind::edges, -1, one, two, -1.0, -normal, n[0] - k[1]});
}

/// [m] Planes that separate by less neither are the best nor share its normal.
double MeetingCorners::worst() const { return most_ - (round + 2.0 * corner_rounding) * size_; }

/// One candidate; planes of a kind that are nearly the same count once.
void MeetingCorners::keep(const Plane& plane) {
  if (plane.apart < worst()) return;
  most_ = std::max(most_, plane.apart);
  for (Plane& known : planes_) {
    if (known.kind != plane.kind || known.normal.dot(plane.normal) < same_direction) continue;
    if (plane.apart > known.apart + corner_rounding * size_) known = plane;
    return;
  }
  planes_.push_back(plane);
}

Eigen::Vector3d MeetingCorners::normal_now(const Plane& plane) const {
  if (plane.kind == Kind::n_plane) return normal_of(n_.now, plane.facet);
  if (plane.kind == Kind::k_plane) return -normal_of(k_.now, plane.facet);
  return plane.sign * along_edge(k_.now, plane.k).cross(along_edge(n_.now, plane.n)).normalized();
}

/// A plane of N's that separates nearly as well as the best, and along which facets of both cover
/// each other; null: there is none.
const MeetingCorners::Plane* MeetingCorners::joining(const Plane& best, const Wedge& a,
                                                     const Wedge& b) const {
  const auto lies_along = [&](const Plane& plane) {
    return std::ranges::any_of(a.planes, [&](std::int32_t f) {
      return -normal_of(k_.before, f).dot(plane.normal) >= along &&
             std::ranges::any_of(b.planes, [&](std::int32_t g) {
               return normal_of(n_.before, g).dot(plane.normal) >= same_direction &&
                      cover(corners(k_.now, f), corners(n_.now, g));
             });
    });
  };
  const Plane* most = nullptr;
  for (const Plane& plane : planes_) {
    if (plane.kind != Kind::n_plane || plane.apart < best.apart - round * size_) continue;
    if ((most == nullptr || plane.apart > most->apart) && lies_along(plane)) most = &plane;
  }
  return most;
}

/// Where a facet's plane parts them by more than is near, no row holds them; all else is asked of
/// few of them (is_dropped), and is dear.
void MeetingCorners::judge(Verdict& verdict) {
  verdict.found = find_planes(verdict.k, verdict.n);
  const Found& found = found_[verdict.found];
  size_ = found.size;
  verdict.told = found.of_facets > reach() + 2.0 * corner_rounding * size_;
  if (!verdict.told) judge_whole(verdict);
}

void MeetingCorners::judge_whole(Verdict& verdict) {
  const Wedge &a = (*k_.wedges)[verdict.k], &b = (*n_.wedges)[verdict.n];
  verdict.whole = true;
  find_all_planes(verdict);
  const Plane& best = *std::ranges::max_element(planes_, [this](const Plane& p, const Plane& q) {
    return p.apart + corner_rounding * size_ < q.apart;
  });
  if (best.apart < -options_.way - deep * size_) return;
  verdict.told = true;
  const Plane* joined = joining(best, a, b);
  verdict.joined = joined != nullptr;
  verdict.normal = joined != nullptr ? joined->normal : best.normal;
  if (verdict.joined || best.apart > reach()) return;
  shared_.setZero();
  for (const Plane& plane : planes_) {
    const double share = 1.0 - (best.apart - plane.apart) / (round * size_);
    if (share > 0.0 && &plane != &best) shared_ += share * normal_now(plane);
  }
  if (best.kind == Kind::n_plane) add_nodes(best, a, b);
  if (best.kind == Kind::k_plane) add_nodes(best, b, a);
  verdict.crosses = best.kind == Kind::edges && add_crossing(best, a, b);
}

/// Edges that cross tell of all facets around them. Else a pair stays where a plane that joins its
/// wedges lies along it, and is dropped where there is another: by wedges that hold it or, where it
/// is steep, that it touches.
bool MeetingCorners::is_dropped(FacetPair pair) {
  const Eigen::Vector3d &out_k = k_now_.at(k_.now, pair.k), &out_n = n_now_.at(n_.now, pair.n);
  if (out_k.dot(out_n) > -options_.facing) return false;  // it is none
  const bool faced = out_k.dot(out_n) <= -same_direction;
  const std::span<const std::int32_t> at_k = k_.wedges->at(pair.k), at_n = n_.wedges->at(pair.n);
  bool stays = false, other = false;
  const std::span<const std::int32_t> twos = crosses_ ? n_.wedges->around(pair.n) : at_n;
  for (const std::int32_t one : crosses_ ? k_.wedges->around(pair.k) : at_k) {
    const bool held = has((*k_.wedges)[one], pair.k);
    if (faced && !held) continue;
    const bool touched = std::ranges::binary_search(at_k, one);
    // both ordered: what they have in common is met on one way through them
    auto two = twos.begin();
    for (Verdict& v : verdicts_of(one)) {
      two = std::find_if(two, twos.end(), [&v](std::int32_t n) { return n >= v.n; });
      if (two == twos.end()) break;
      if (*two != v.n || !v.told) continue;
      if (faced && !has((*n_.wedges)[v.n], pair.n)) continue;
      if (v.crosses) return true;
      if (!touched || !std::ranges::binary_search(at_n, v.n)) continue;
      if (!v.whole) judge_whole(v);
      const bool fits = out_n.dot(v.normal) >= along && -out_k.dot(v.normal) >= along;
      (v.joined && fits ? stays : other) = true;
      if (stays && !crosses_) return false;
    }
  }
  return other && !stays;
}

}  // namespace abut
