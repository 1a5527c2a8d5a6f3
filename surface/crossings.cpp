#include "surface/crossings.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace abut {

namespace {

/// Of a facet: what is nearer to it touches.
constexpr double least = 1.0e-6;

bool share_a_node(const PosedSurface& s, FacetPair pair) {
  const std::span<const std::int32_t> b = s.nodes(pair.n);
  return std::ranges::any_of(
      s.nodes(pair.k), [b](std::int32_t node) { return std::ranges::find(b, node) != b.end(); });
}

/// Whether two points lie clearly on either side of a plane; `part`: of the way between them.
bool on_either_side(double from, double to, double size, double& part) {
  if (!(std::min(std::abs(from), std::abs(to)) > least * size) || (from > 0.0) == (to > 0.0))
    return false;
  part = from / (from - to);
  return true;
}

/// Segments of the plane.
bool triangles_cross(const Corners& a, const Corners& b) {
  const auto apart = [](const Corners& one, const Corners& other) {
    const Eigen::Vector3d n = mean_normal(one);
    double part;
    return on_either_side(n.dot(other.x[0] - one.x[0]), n.dot(other.x[1] - one.x[0]), area(one),
                          part);
  };
  return apart(a, b) && apart(b, a);
}

/// Whether a way goes through the inside of a triangle; its first edge may be inside a facet.
bool goes_through(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                  const std::array<Eigen::Vector3d, 3>& t, bool first_is_inside) {
  const Eigen::Vector3d whole = (t[1] - t[0]).cross(t[2] - t[0]);
  const double twice = whole.norm();
  if (!(twice > 0.0)) return false;
  const Eigen::Vector3d n = whole / twice;
  double part;
  if (!on_either_side(n.dot(from - t[0]), n.dot(to - t[0]), std::sqrt(twice), part)) return false;
  const Eigen::Vector3d x = from + part * (to - from);
  for (std::size_t i = 0; i < 3; ++i) {
    const double share = n.dot((t[(i + 1) % 3] - t[i]).cross(x - t[i])) / twice;
    if (share < (i == 0 && first_is_inside ? 0.0 : least)) return false;
  }
  return true;
}

/// Whether an edge of one goes through the other.
bool pierces(const Corners& one, const Corners& other) {
  const bool two = other.count == 4;
  for (int e = 0; e < one.count; ++e) {
    const Eigen::Vector3d& from = one.x[e];
    const Eigen::Vector3d& to = one.x[(e + 1) % one.count];
    if (goes_through(from, to, {other.x[2], other.x[0], other.x[1]}, two)) return true;
    if (two && goes_through(from, to, {other.x[0], other.x[2], other.x[3]}, true)) return true;
  }
  return false;
}

}  // namespace

Crossings crossings(const PosedSurface& surface, const BoxTree& tree,
                    std::vector<FacetPair>& pairs) {
  Crossings found;
  overlapping_pairs(tree, tree, pairs);
  for (const FacetPair& pair : pairs) {
    if (pair.k >= pair.n || share_a_node(surface, pair)) continue;
    const Corners a = corners(surface, pair.k), b = corners(surface, pair.n);
    if (!(surface.dim == 2 ? triangles_cross(a, b) : pierces(a, b) || pierces(b, a))) continue;
    if (found.count++ == 0) found.first = pair;
  }
  return found;
}

}  // namespace abut
