#include "surface/plane_facet.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace abut {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Coordinates of z in a quadrilateral. With r = z - c0, b solves
///   (cb x cab) b^2 + (cb x ca - r x cab) b - r x ca = 0,
/// and the derivative of the left side there is -J, J the Jacobian of the map: so of the two roots
/// the one with that sign is meant, also where the quadratic term vanishes.
Eigen::Vector2d root(const PlaneFacet& f, const Eigen::Vector2d& r) {
  const double turn = cross(f.ca, f.cb) < 0.0 ? -1.0 : 1.0;
  const double p = turn * cross(f.cb, f.cab);
  const double q = turn * (cross(f.cb, f.ca) - cross(r, f.cab));
  const double c = -turn * cross(r, f.ca);
  const double jacobian = std::sqrt(std::max(0.0, q * q - 4.0 * p * c));
  const double b = q < 0.0 ? 2.0 * c / (jacobian - q) : -(q + jacobian) / (2.0 * p);
  const Eigen::Vector2d along = f.ca + f.cab * b;
  return {along.dot(r - f.cb * b) / along.squaredNorm(), b};
}

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
  const double j = 1.0 / cross(f.ca, f.cb);
  f.da = j * Eigen::Vector2d(f.cb.y(), -f.cb.x());
  f.db = f.count == 2 ? Eigen::Vector2d::Zero() : Eigen::Vector2d(-j * f.ca.y(), j * f.ca.x());
  return f;
}

Eigen::Vector2d PlaneFacet::inverse(const Eigen::Vector2d& r) const {
  const Eigen::Vector2d p = root(*this, r);
  const Eigen::Vector2d rest = r - ca * p.x() - cb * p.y() - cab * (p.x() * p.y());
  const Eigen::Vector2d along_a = ca + cab * p.y(), along_b = cb + cab * p.x();
  const double j = 1.0 / cross(along_a, along_b);
  return {p.x() + cross(rest, along_b) * j, p.y() + cross(along_a, rest) * j};
}

Polygon PlaneFacet::polygon() const {
  Polygon p;
  double turn = 0.0;
  for (int i = 2; i < count; ++i) turn += cross(x[i - 1] - x[0], x[i] - x[0]);
  for (int i = 0; i < count; ++i) p.add(turn < 0.0 ? x[count - 1 - i] : x[i]);
  return p;
}

}  // namespace abut
