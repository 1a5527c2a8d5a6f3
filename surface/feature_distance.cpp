#include "surface/feature_distance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace abut {
namespace {

using Vector = Eigen::Vector3d;

/// The point of a segment from 0 to u that is closest to p, as a part of u; 0 without a length.
double part_of(const Vector& u, const Vector& p) {
  const double square = u.squaredNorm();
  return square > 0.0 ? std::clamp(u.dot(p) / square, 0.0, 1.0) : 0.0;
}

/// The best of the candidates so far. All places are relative to a point of the pair, so that
/// nothing depends on where in space it is.
struct Best {
  double square = std::numeric_limits<double>::infinity();
  std::array<double, 4> weights{};

  void take(const Vector& difference, const std::array<double, 4>& w) {
    const double s = difference.squaredNorm();
    if (!(s < square)) return;
    square = s;
    weights = w;
  }
  FeatureDistance result() const { return {std::sqrt(square), weights}; }
};

FeatureDistance node_segment(const FeaturePoints& x) {
  const Vector u = x[2] - x[1], p = x[0] - x[1];
  const double s = part_of(u, p);
  return {(p - s * u).norm(), {1.0, s - 1.0, -s, 0.0}};
}

FeatureDistance node_triangle(const FeaturePoints& x) {
  const Vector p = x[0] - x[1], u = x[2] - x[1], v = x[3] - x[1], n = u.cross(v);
  Best best;
  const double square = n.squaredNorm();
  if (square > 0.0) {
    double b = p.cross(v).dot(n) / square, c = u.cross(p).dot(n) / square;
    // In a sliver the normal's rounding moves the point along it: brought back by its long side.
    const bool along_u = u.squaredNorm() > v.squaredNorm();
    const Vector& side = along_u ? u : v;
    (along_u ? b : c) += (p - b * u - c * v).dot(side) / side.squaredNorm();
    if (b > 0.0 && c > 0.0 && b + c < 1.0) best.take(p - b * u - c * v, {1.0, b + c - 1.0, -b, -c});
  }
  const double on_u = part_of(u, p), on_v = part_of(v, p), on_w = part_of(v - u, p - u);
  best.take(p - on_u * u, {1.0, on_u - 1.0, -on_u, 0.0});
  best.take(p - on_v * v, {1.0, on_v - 1.0, 0.0, -on_v});
  best.take(p - u - on_w * (v - u), {1.0, 0.0, on_w - 1.0, -on_w});
  return best.result();
}

/// The solution inside by the edges' common normal; of nearly parallel edges it loses digits along
/// the first of them, which cost no distance as the other point is then looked for, while the
/// determinant of the normal equations loses all of them.
FeatureDistance edge_edge(const FeaturePoints& x) {
  const Vector u = x[1] - x[0], v = x[3] - x[2], r = x[2] - x[0], n = u.cross(v);
  Best best;
  const auto take = [&best, &u, &v, &r](double s, double t) {
    best.take(s * u - t * v - r, {1.0 - s, s, t - 1.0, -t});
  };
  const double square = n.squaredNorm();
  if (square > 0.0) {
    const double s = r.cross(v).dot(n) / square, t = r.cross(u).dot(n) / square;
    if (s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0) take(s, part_of(v, s * u - r));
  }
  take(0.0, part_of(v, -r));
  take(1.0, part_of(v, u - r));
  take(part_of(u, r), 0.0);
  take(part_of(u, r + v), 1.0);
  return best.result();
}

}  // namespace

FeatureDistance feature_distance(FeatureKind kind, int dim, const FeaturePoints& x) {
  if (kind == FeatureKind::edge_edge) return edge_edge(x);
  return dim == 2 ? node_segment(x) : node_triangle(x);
}

}  // namespace abut
