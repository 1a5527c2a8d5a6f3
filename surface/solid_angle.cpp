#include "surface/solid_angle.hpp"

#include <array>
#include <cmath>

namespace abut {

namespace {

double plane_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(b.x() * a.y() - b.y() * a.x(), a.dot(b));
}

/// A. van Oosterom, J. Strackee: The solid angle of a plane triangle. IEEE Trans. Biomed. Eng. 30
/// (1983), 125-126.
double triangle_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                      const Eigen::Vector3d& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return -2.0 * std::atan2(a.dot(b.cross(c)),
                           la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace

double solid_angle(const PosedSurface& surface, const Eigen::Vector3d& x) {
  double sum = 0.0;
  for (int f = 0; f < surface.facet_count(); ++f) {
    Corners facet = corners(surface, f);
    for (int i = 0; i < facet.count; ++i) facet.x[i] -= x;
    const auto& [a, b, c, d] = facet.x;
    if (facet.count == 2) sum += plane_angle(a, b);
    if (facet.count >= 3) sum += triangle_angle(a, b, c);
    if (facet.count == 4) sum += triangle_angle(a, c, d);
  }
  return sum;
}

}  // namespace abut
