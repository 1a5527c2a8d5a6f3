#include "surface/closest_point.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/assert.hpp"
#include "surface/closest_on_quad.hpp"

namespace abut {
namespace {

/// Share of the way from a to b that is closest to x; 0 where both are one point.
double closest_share(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& x) {
  const Eigen::Vector3d way = b - a;
  const double square = way.squaredNorm();
  return square > 0.0 ? std::clamp(way.dot(x - a) / square, 0.0, 1.0) : 0.0;
}

/// The point on edge `i` of a facet, as if that edge were all.
ClosestPoint closest_on_edge(const Corners& facet, int i, const Eigen::Vector3d& x) {
  const int next = i + 1 == facet.count ? 0 : i + 1;
  const double share = closest_share(facet.x[i], facet.x[next], x);
  ClosestPoint c;
  c.shape.setZero();
  c.shape[i] = 1.0 - share;
  c.shape[next] = share;
  c.point = facet.x[i] + share * (facet.x[next] - facet.x[i]);
  c.distance = (x - c.point).norm();
  const bool end = share == 0.0 || share == 1.0;
  c.feature = end ? FacetFeature::vertex : FacetFeature::edge;
  c.index = share == 1.0 ? next : i;
  return c;
}

ClosestPoint closest_on_edges(const Corners& facet, const Eigen::Vector3d& x) {
  ClosestPoint best = closest_on_edge(facet, 0, x);
  for (int i = 1; i < facet.count; ++i) {
    const ClosestPoint other = closest_on_edge(facet, i, x);
    if (other.distance < best.distance) best = other;
  }
  return best;
}

ClosestPoint inside(const Corners& facet, const Shape4& shape, const Eigen::Vector3d& x) {
  ClosestPoint c;
  c.shape = shape;
  c.point.setZero();
  for (int i = 0; i < facet.count; ++i) c.point += shape[i] * facet.x[i];
  c.distance = (x - c.point).norm();
  return c;
}

/// The foot of the perpendicular when it falls inside, else the best of the edges.
ClosestPoint closest_on_triangle(const Corners& facet, const Eigen::Vector3d& x) {
  const Eigen::Vector3d u = facet.x[1] - facet.x[0], v = facet.x[2] - facet.x[0];
  const Eigen::Vector3d r = x - facet.x[0], n = u.cross(v);
  const double square = n.squaredNorm();
  const double a = r.cross(v).dot(n), b = u.cross(r).dot(n);
  if (!(a > 0.0 && b > 0.0 && a + b < square)) return closest_on_edges(facet, x);
  return inside(facet, {1.0 - (a + b) / square, a / square, b / square, 0.0}, x);
}

/// Where Newton begins: the closest point of the two triangles that a diagonal makes.
Shape4 on_split(const Corners& quad, const Eigen::Vector3d& x) {
  const ClosestPoint a = closest_on_triangle({3, {quad.x[0], quad.x[1], quad.x[2]}}, x);
  const ClosestPoint b = closest_on_triangle({3, {quad.x[0], quad.x[2], quad.x[3]}}, x);
  if (b.distance < a.distance) return {b.shape[0], 0.0, b.shape[1], b.shape[2]};
  return {a.shape[0], a.shape[1], a.shape[2], 0.0};
}

ClosestPoint closest_on_quadrilateral(const Corners& facet, const Eigen::Vector3d& x) {
  const ClosestPoint best = closest_on_edges(facet, x);
  const std::optional<Shape4> shape = stationary_on_quad(facet, x, on_split(facet, x));
  if (!shape) return best;
  const ClosestPoint other = inside(facet, *shape, x);
  return other.distance < best.distance ? other : best;
}

/// Square of the distance of x from a box.
double square_distance(const Box& box, const Eigen::Vector3d& x) {
  double square = 0.0;
  for (int d = 0; d < 3; ++d) {
    const double out = std::max({0.0, box.low[d] - x[d], x[d] - box.high[d]});
    square += out * out;
  }
  return square;
}

void set_local(const Corners& facet, ClosestPoint& c) {
  const Shape4& s = c.shape;
  if (facet.count < 4)
    c.local = {s[1], s[2]};
  else
    c.local = {s[1] + s[2] - s[0] - s[3], s[2] + s[3] - s[0] - s[1]};
}

}  // namespace

ClosestPoint closest_point(const Corners& facet, const Eigen::Vector3d& x) {
  ClosestPoint c;
  if (facet.count == 2) {
    c = closest_on_edge(facet, 0, x);
    if (c.feature == FacetFeature::edge) c.feature = FacetFeature::inside, c.index = -1;
  } else if (facet.count == 3) {
    c = closest_on_triangle(facet, x);
  } else {
    c = closest_on_quadrilateral(facet, x);
  }
  set_local(facet, c);
  return c;
}

std::optional<SurfacePoint> closest_point(const PosedSurface& surface, const BoxTree& tree,
                                          const Eigen::Vector3d& x, const ClosestSearch& search) {
  if (tree.empty()) return std::nullopt;
  std::optional<SurfacePoint> best;
  double bound = search.reach * search.reach;
  constexpr int capacity = 40;  // one node per level of a tree of less than 2^31 facets
  std::array<std::pair<std::int32_t, double>, capacity> stack;
  int count = 0;
  stack[count++] = {0, square_distance(tree.boxes[0], x)};
  while (count > 0) {
    const auto [node, square] = stack[--count];
    if (square > bound) continue;
    if (!tree.is_leaf(node)) {
      ABUT_ASSERT(count + 2 <= capacity);
      const std::int32_t first = node + 1, second = tree.second[node];
      const std::pair<std::int32_t, double> a{first, square_distance(tree.boxes[first], x)};
      const std::pair<std::int32_t, double> b{second, square_distance(tree.boxes[second], x)};
      const bool nearer = a.second <= b.second;
      stack[count++] = nearer ? b : a;
      stack[count++] = nearer ? a : b;
      continue;
    }
    const int facet = tree.facet(node);
    const Corners c = corners(surface, facet);
    if (!(mean_normal(c).dot(search.against) <= -search.facing)) continue;
    const ClosestPoint at = closest_point(c, x);
    const double reached = best ? best->at.distance : search.reach;
    if (at.distance > reached || (best && at.distance == reached && facet > best->facet)) continue;
    best = SurfacePoint{facet, at};
    bound = at.distance * at.distance;
  }
  return best;
}

}  // namespace abut
