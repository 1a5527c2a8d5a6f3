#include "tests/random/sweep.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace abut {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr double edge = 1e-9;  // of a feature: what just grazes it meets it

/// How far along d from a point to a triangle or, in the plane, to a line a b.
double point_to(const Eigen::Vector3d& x, const Eigen::Vector3d& d,
                const std::array<Eigen::Vector3d, 3>& f, int dim) {
  Eigen::Matrix3d m;
  m.col(0) = d;
  m.col(1) = f[0] - f[1];
  m.col(2) = dim == 2 ? Eigen::Vector3d::UnitZ().eval() : (f[0] - f[2]).eval();
  if (std::abs(m.determinant()) < 1e-14 * m.col(1).norm() * m.col(2).norm()) return never;
  const Eigen::Vector3d s = m.inverse() * (f[0] - x);
  if (s(1) < -edge) return never;
  if (dim == 2) return s(1) > 1.0 + edge ? never : s(0);
  return s(2) < -edge || s(1) + s(2) > 1.0 + edge ? never : s(0);
}

/// How far an edge can go along d to another one.
double edge_to(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& d,
               const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  Eigen::Matrix3d m;
  m.col(0) = d;
  m.col(1) = b - a;
  m.col(2) = p - q;
  if (std::abs(m.determinant()) < 1e-14 * m.col(1).norm() * m.col(2).norm()) return never;
  const Eigen::Vector3d s = m.inverse() * (p - a);
  const bool meets = s(1) > -edge && s(1) < 1.0 + edge && s(2) > -edge && s(2) < 1.0 + edge;
  return meets ? s(0) : never;
}

/// Facets as simplices; quadrilaterals along both diagonals, as either may be met.
std::vector<std::array<Eigen::Vector3d, 3>> simplices(const Outside& part) {
  std::vector<std::array<Eigen::Vector3d, 3>> out;
  for (const std::vector<int>& f : part.facets) {
    const auto at = [&](int i) { return part.points[f[i]]; };
    if (part.dim == 2) out.push_back({at(0), at(1), at(0)});
    if (part.dim == 3) out.push_back({at(0), at(1), at(2)});
    if (f.size() == 4) {
      out.push_back({at(0), at(2), at(3)});
      out.push_back({at(0), at(1), at(3)});
      out.push_back({at(1), at(2), at(3)});
    }
  }
  return out;
}

}  // namespace

double way_to(const Outside& moving, const Outside& other, const Eigen::Vector3d& direction) {
  double least = never;
  const auto see = [&least](double way) { least = std::min(least, way); };
  const auto ours = simplices(moving), theirs = simplices(other);
  const auto corners = [](const Outside& part, const auto& visit) {
    for (const std::vector<int>& f : part.facets)
      for (const int n : f) visit(part.points[n]);
  };
  for (const auto& facet : theirs)
    corners(moving, [&](const auto& x) { see(point_to(x, direction, facet, moving.dim)); });
  for (const auto& facet : ours)
    corners(other, [&](const auto& x) { see(point_to(x, -direction, facet, moving.dim)); });
  if (moving.dim == 3)
    for (const auto& f : ours)
      for (const auto& g : theirs)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            see(edge_to(f[i], f[(i + 1) % 3], direction, g[j], g[(j + 1) % 3]));
  return least;
}

}  // namespace abut
