#include "surface/plane_facet.hpp"

#include <limits>

namespace abut {
namespace {

double turn_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// r times `v` turned by a right angle is r x v.
Eigen::Vector2d turned(const Eigen::Vector2d& v) { return {v.y(), -v.x()}; }

}  // namespace

AuxiliaryPlane auxiliary_plane(const Corners& facet) {
  AuxiliaryPlane plane;
  plane.origin = centre(facet);
  plane.normal = mean_normal(facet);
  const Eigen::Vector3d edge = facet.x[1] - facet.x[0];
  plane.first = (edge - edge.dot(plane.normal) * plane.normal).normalized();
  plane.second = plane.normal.cross(plane.first);
  return plane;
}

PlaneFacet seen_in(const AuxiliaryPlane& plane, const Corners& facet) {
  PlaneFacet f;
  f.count = facet.count;
  for (int i = 0; i < facet.count; ++i) f.x[i] = plane.project(facet.x[i]);
  f.c0 = f.x[0];
  f.ca = f.x[1] - f.x[0];
  f.cb = {0.0, 1.0};  // of a segment: anything across
  f.cab.setZero();
  if (f.count == 2) f.ca.y() = 0.0;
  if (f.count == 3) f.cb = f.x[2] - f.x[0];
  if (f.count == 4) {
    f.c0 = 0.25 * (f.x[0] + f.x[1] + f.x[2] + f.x[3]);
    f.ca = 0.25 * (-f.x[0] + f.x[1] + f.x[2] - f.x[3]);
    f.cb = 0.25 * (-f.x[0] - f.x[1] + f.x[2] + f.x[3]);
    f.cab = 0.25 * (f.x[0] - f.x[1] + f.x[2] - f.x[3]);
    // A parallelogram to round-off: its map is straight.
    constexpr double straight = 16.0 * std::numeric_limits<double>::epsilon();
    f.affine =
        f.cab.squaredNorm() <= straight * straight * (f.ca.squaredNorm() + f.cb.squaredNorm());
  }
  const double j = turn_of(f.ca, f.cb), turn = j < 0.0 ? -1.0 : 1.0;
  f.da = turned(f.cb) / j;
  f.db = f.count == 2 ? Eigen::Vector2d::Zero() : Eigen::Vector2d(turned(f.ca) / -j);
  // r = ca a + cb b + cab a b, crossed with ca + cab b
  f.square = turn * turn_of(f.cb, f.cab);
  f.linear = -turn * j;
  f.to_linear = -turn * turned(f.cab);
  f.to_constant = -turn * turned(f.ca);
  return f;
}

Eigen::Vector2d PlaneFacet::corrected(const Eigen::Vector2d& r, const Eigen::Vector2d& ab) const {
  const Eigen::Vector2d rest = r - ca * ab.x() - cb * ab.y() - cab * (ab.x() * ab.y());
  const Eigen::Vector2d along_a = ca + cab * ab.y(), along_b = cb + cab * ab.x();
  const double j = 1.0 / turn_of(along_a, along_b);
  return {ab.x() + turn_of(rest, along_b) * j, ab.y() + turn_of(along_a, rest) * j};
}

Polygon PlaneFacet::polygon() const {
  Polygon p;
  double turn = 0.0;
  for (int i = 2; i < count; ++i) turn += turn_of(x[i - 1] - x[0], x[i] - x[0]);
  for (int i = 0; i < count; ++i) p.add(turn < 0.0 ? x[count - 1 - i] : x[i]);
  return p;
}

}  // namespace abut
