#include "subdomain_solver/overlap/simplices.hpp"

#include <cmath>
#include <utility>

#include <Eigen/Geometry>


namespace abut {

namespace {

/// [m] of a corner, none where it is on the plane.
double distance(const HalfSpace& side, const Eigen::Vector3d& x, double near) {
  const double d = side.distance(x);
  return std::abs(d) <= near ? 0.0 : d;
}

/// Halves an edge that crosses the plane until none does.
void halve(const Simplex& s, const HalfSpace& side, double near, std::vector<Simplex>& inside,
           std::vector<Simplex>* outside) {
  std::array<double, 4> d{};
  int in = -1, out = -1;
  for (int i = 0; i < s.count; ++i) {
    d[i] = distance(side, s.x[i], near);
    if (d[i] < 0.0 && in < 0) in = i;
    if (d[i] > 0.0 && out < 0) out = i;
  }
  if (out < 0) {
    inside.push_back(s);
  } else if (in < 0) {
    if (outside != nullptr) outside->push_back(s);
  } else {
    const double share = d[in] / (d[in] - d[out]);
    const Eigen::Vector3d cut = s.x[in] + share * (s.x[out] - s.x[in]);
    for (const int corner : {in, out}) {
      Simplex half = s;
      half.x[corner] = cut;
      halve(half, side, near, inside, outside);
    }
  }
}

}  // namespace

double measure(const Simplex& s) {
  const Eigen::Vector3d a = s.x[1] - s.x[0];
  if (s.count == 2) return a.norm();
  const Eigen::Vector3d normal = a.cross(s.x[2] - s.x[0]);
  if (s.count == 3) return 0.5 * normal.norm();
  return std::abs(normal.dot(s.x[3] - s.x[0])) / 6.0;
}

std::vector<HalfSpace> sides_of(const Simplex& s) {
  std::vector<HalfSpace> sides;
  for (int apex = 0; apex < s.count; ++apex) {
    const auto corner = [&](int k) -> const Eigen::Vector3d& {
      return s.x[(apex + k) % s.count];
    };
    const Eigen::Vector3d along = corner(2) - corner(1);
    Eigen::Vector3d normal = s.count == 3 ? Eigen::Vector3d(along.y(), -along.x(), 0.0)
                                          : along.cross(corner(3) - corner(1));
    normal.normalize();
    if (normal.dot(corner(0) - corner(1)) > 0.0) normal = -normal;
    sides.push_back({normal, normal.dot(corner(1))});
  }
  return sides;
}

void divide(const Simplex& simplex, const std::vector<HalfSpace>& sides, double near,
            std::vector<Simplex>& inside, std::vector<Simplex>* outside) {
  inside.assign(1, simplex);
  std::vector<Simplex> left;
  for (const HalfSpace& side : sides) {
    left.swap(inside);
    inside.clear();
    for (const Simplex& part : left) halve(part, side, near, inside, outside);
    if (inside.empty()) return;
  }
}

}  // namespace abut
