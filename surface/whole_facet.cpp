#include "surface/whole_facet.hpp"

#include <Eigen/LU>
#include <cstddef>

namespace abut {
namespace {

struct Hats {
  Shape4 value = Shape4::Zero();
  Eigen::Matrix<double, 4, 2> slope = Eigen::Matrix<double, 4, 2>::Zero();
};

constexpr double square[4][2] = {{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}};

Hats hats_of(int corners, const Eigen::Vector2d& at) {
  Hats hats;
  const double a = at.x(), b = at.y();
  if (corners == 2) {
    hats.value << 0.5 * (1.0 - a), 0.5 * (1.0 + a), 0.0, 0.0;
    hats.slope.col(0) << -0.5, 0.5, 0.0, 0.0;
  } else if (corners == 3) {
    hats.value << 1.0 - a - b, a, b, 0.0;
    hats.slope.col(0) << -1.0, 1.0, 0.0, 0.0;
    hats.slope.col(1) << -1.0, 0.0, 1.0, 0.0;
  } else {
    for (int i = 0; i < 4; ++i) {
      const double s = square[i][0], t = square[i][1];
      hats.value[i] = 0.25 * (1.0 + s * a) * (1.0 + t * b);
      hats.slope(i, 0) = 0.25 * s * (1.0 + t * b);
      hats.slope(i, 1) = 0.25 * t * (1.0 + s * a);
    }
  }
  return hats;
}

/// 1 in the middle between corners i and j, 0 on all other edges.
double between(const Hats& hats, int corners, int i, int j, const Eigen::Vector2d& at,
               Eigen::RowVector2d& slope) {
  if (corners < 4) {
    slope = 4.0 * (hats.slope.row(i) * hats.value[j] + hats.value[i] * hats.slope.row(j));
    return 4.0 * hats.value[i] * hats.value[j];
  }
  const int along = square[i][0] == square[j][0] ? 1 : 0, across = 1 - along;
  const double bubble = 1.0 - at[along] * at[along], side = square[i][across];
  slope[along] = -at[along] * (1.0 + side * at[across]);
  slope[across] = 0.5 * bubble * side;
  return 0.5 * bubble * (1.0 + side * at[across]);
}

}  // namespace

FacetKind::FacetKind(int dim, std::size_t count)
    : nodes(static_cast<int>(count)),
      corners(dim == 2         ? 2
              : count % 3 == 0 ? 3
                               : 4) {}

Shape4 FacetKind::hats(const Eigen::Vector2d& at) const { return hats_of(corners, at).value; }

void FacetKind::evaluate(const Eigen::Vector2d& at, Shape8& n, Slopes8& slopes) const {
  const Hats hats = hats_of(corners, at);
  n.setZero();
  slopes.setZero();
  n.head<4>() = hats.value;
  slopes.topRows<4>() = hats.slope;
  for (int node = corners; node < nodes; ++node) {
    const int i = node - corners, j = (i + 1) % corners;
    Eigen::RowVector2d slope = Eigen::RowVector2d::Zero();
    n[node] = between(hats, corners, i, j, at, slope);
    slopes.row(node) = slope;
    for (const int corner : {i, j}) {
      n[corner] -= 0.5 * n[node];
      slopes.row(corner) -= 0.5 * slope;
    }
  }
}

Eigen::Vector2d FacetKind::place(int node) const {
  if (node >= corners) {
    const int i = node - corners;
    return 0.5 * (place(i) + place((i + 1) % corners));
  }
  if (corners == 2) return {node == 0 ? -1.0 : 1.0, 0.0};
  if (corners == 3) return {node == 1 ? 1.0 : 0.0, node == 2 ? 1.0 : 0.0};
  return {square[node][0], square[node][1]};
}

WholeFacet::WholeFacet(const AuxiliaryPlane& plane, const PosedSurface& surface,
                       std::span<const std::int32_t> nodes)
    : kind(surface.dim, nodes.size()) {
  x.setZero();
  for (std::size_t a = 0; a < nodes.size(); ++a)
    x.col(static_cast<Eigen::Index>(a)) = plane.project(surface.point(nodes[a]));
  if (surface.dim == 2) x.row(1).setZero();
}

Eigen::Vector2d WholeFacet::find(const Eigen::Vector2d& z, const Eigen::Vector2d& guess) const {
  constexpr int most_steps = 20;
  constexpr double close = 1.0e-8;  // steps so short leave their square, round-off
  constexpr double near = 1.0;      // a whole edge of the triangle, half of one of the square
  const bool line = kind.corners == 2;
  Eigen::Vector2d at = guess;
  Shape8 n;
  Slopes8 slopes;
  for (int step = 0; step < most_steps; ++step) {
    kind.evaluate(at, n, slopes);
    Eigen::Matrix2d along = x * slopes;
    if (line) along.col(1) = Eigen::Vector2d::UnitY();
    Eigen::Vector2d rest = z - x * n;
    if (line) rest.y() = 0.0;
    const Eigen::Vector2d by = along.inverse() * rest;
    at += by;
    if (!((at - guess).norm() <= near)) return guess;
    if (by.norm() <= close) return at;
  }
  return guess;
}

}  // namespace abut
