#include "surface/closest_on_quad.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace abut {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Half the square of the distance of x from c0 + ca a + cb b + cab a b, as a function of a and b.
struct HalfSquare {
  Vector3d c0, ca, cb, cab;  // c0 relative to x

  Vector3d at(const Vector2d& p) const {
    return c0 + ca * p.x() + cb * p.y() + cab * (p.x() * p.y());
  }
  double value(const Vector2d& p) const { return 0.5 * at(p).squaredNorm(); }
};

Vector2d clamped(const Vector2d& p) { return p.cwiseMax(-1.0).cwiseMin(1.0); }

/// Newton's step; the curvature of the surface is left out where it would lead uphill.
Vector2d newton_step(const HalfSquare& f, const Vector2d& p, Vector2d& gradient) {
  const Vector3d r = f.at(p), da = f.ca + f.cab * p.y(), db = f.cb + f.cab * p.x();
  gradient = {r.dot(da), r.dot(db)};
  Eigen::Matrix2d h;
  h << da.squaredNorm(), da.dot(db), da.dot(db), db.squaredNorm();
  Eigen::Matrix2d full = h;
  full(0, 1) += r.dot(f.cab);
  full(1, 0) = full(0, 1);
  if (full.determinant() > 0.0) h = full;
  // A coordinate at its bound that wants out stays there; the other one moves on its own.
  for (int i = 0; i < 2; ++i) {
    if (std::abs(p[i]) < 1.0 || gradient[i] * p[i] >= 0.0) continue;
    h(0, 1) = h(1, 0) = 0.0;
    gradient[i] = 0.0;
  }
  return -h.inverse() * gradient;
}

}  // namespace

std::optional<Shape4> stationary_on_quad(const Corners& quad, const Eigen::Vector3d& x,
                                         const Shape4& guess) {
  const auto& q = quad.x;
  const HalfSquare f{0.25 * (q[0] + q[1] + q[2] + q[3]) - x, 0.25 * (-q[0] + q[1] + q[2] - q[3]),
                     0.25 * (-q[0] - q[1] + q[2] + q[3]), 0.25 * (q[0] - q[1] + q[2] - q[3])};
  Vector2d p(guess[1] + guess[2] - guess[0] - guess[3], guess[2] + guess[3] - guess[0] - guess[1]);
  double value = f.value(p);
  // Values this near to each other are equal: the last steps improve the place, not the value.
  const double noise = 8.0 * std::numeric_limits<double>::epsilon() *
                       (f.c0.squaredNorm() + f.ca.squaredNorm() + f.cb.squaredNorm());
  constexpr int most_steps = 50;     // a few, quadratic; many only where steps keep being cut
  constexpr double settled = 1e-18;  // of the square of a step: the next one would be round-off
  for (int k = 0; k < most_steps; ++k) {
    Vector2d gradient;
    const Vector2d step = newton_step(f, p, gradient);
    if (!step.allFinite()) break;
    double part = 1.0;
    Vector2d next = clamped(p + step);
    while (f.value(next) > value + noise && part > 1e-6) {
      part *= 0.5;
      next = clamped(p + part * step);
    }
    if (f.value(next) > value + noise) break;
    const double moved = (next - p).squaredNorm();
    p = next;
    value = f.value(p);
    if (moved < settled) break;
  }
  if (std::abs(p.x()) >= 1.0 || std::abs(p.y()) >= 1.0) return std::nullopt;
  const double a = p.x(), b = p.y();
  return Shape4(0.25 * (1.0 - a) * (1.0 - b), 0.25 * (1.0 + a) * (1.0 - b),
                0.25 * (1.0 + a) * (1.0 + b), 0.25 * (1.0 - a) * (1.0 + b));
}

}  // namespace abut
