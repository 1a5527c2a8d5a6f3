#include "subdomain_solver/solve/unilateral_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.hpp"

namespace abut {

namespace {

constexpr int most_sets = 30;
/// Of the largest force, or of the largest gap: changes below it are rounding.
constexpr double settled = 1.0e-14;

/// Of the largest compliance. Rows that say the same share their force by it, and gaps are left
/// that are smaller by as much than what the forces move.
constexpr double softness = 1.0e-11;

/// Forces of the pressed rows, each of which gives way by `soft` [m/N] of its own, that close their
/// gaps. False: the rows are not independent.
bool close(const Eigen::MatrixXd& a, const Vector& gap, double soft, Vector& force,
           UnilateralBuffers& b) {
  const Eigen::Index n = static_cast<Eigen::Index>(b.pressed.size());
  force.setZero();
  if (n == 0) return true;
  b.part.resize(n, n);
  b.rest.resize(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index column = b.pressed[k];
    for (Eigen::Index i = 0; i < n; ++i) b.part(i, k) = a(b.pressed[i], column);
    b.part(k, k) += soft;
    b.rest(k) = -gap(column);
  }
  if (!b.factors.compute(b.part)) return false;
  b.factors.solve(b.rest, b.answer);
  if (!b.answer.allFinite()) return false;
  for (Eigen::Index k = 0; k < n; ++k) force(b.pressed[k]) = b.answer(k);
  return true;
}

bool by_active_sets(const Eigen::MatrixXd& a, const Vector& gap, Vector& force,
                    UnilateralBuffers& b) {
  const double least = settled * gap.lpNorm<Eigen::Infinity>();
  for (int set = 0; set < most_sets; ++set) {
    b.pressed.clear();
    for (Eigen::Index i = 0; i < gap.size(); ++i)
      if (b.is_pressed[i]) b.pressed.push_back(i);
    if (!close(a, gap, 0.0, force, b)) return false;
    b.gap = gap;
    b.gap.noalias() += a * force;
    bool same = true;
    for (Eigen::Index i = 0; i < gap.size(); ++i) {
      const char before = b.is_pressed[i];
      b.is_pressed[i] = before ? force(i) > 0.0 : b.gap(i) < -least;
      same = same && before == b.is_pressed[i];
    }
    if (same) return true;
  }
  return false;
}

/// From forces that press to those that close the gaps of the pressed rows, no farther than to
/// where one of them would pull: that row is released. True: none did.
bool press(const Eigen::MatrixXd& a, const Vector& gap, double soft, Vector& force,
           UnilateralBuffers& b) {
  b.pressed.clear();
  for (Eigen::Index i = 0; i < gap.size(); ++i)
    if (b.is_pressed[i]) b.pressed.push_back(i);
  b.from = force;
  if (!close(a, gap, soft, force, b)) {
    force.setConstant(std::numeric_limits<double>::quiet_NaN());  // told by the caller
    return true;
  }
  double way = 1.0;
  Eigen::Index first = -1;
  for (const Eigen::Index i : b.pressed) {
    if (force(i) > 0.0) continue;
    const double to = b.from(i) / (b.from(i) - force(i));
    if (first >= 0 && to >= way) continue;
    first = i;
    way = to;
  }
  if (first < 0) return true;
  force = b.from + way * (force - b.from);
  for (const Eigen::Index i : b.pressed) force(i) = std::max(0.0, force(i));
  force(first) = 0.0;
  b.is_pressed[first] = 0;
  return false;
}

/// One row after the other, so that every step lessens the energy  f.A.f/2 + gap.f: it ends. Lawson
/// and Hanson, Solving Least Squares Problems (1974), chapter 23.
bool by_rows(const Eigen::MatrixXd& a, const Vector& gap, double soft, Vector& force,
             UnilateralBuffers& b) {
  force = force.cwiseMax(0.0);
  for (Eigen::Index i = 0; i < gap.size(); ++i) b.is_pressed[i] = force(i) > 0.0;
  const Eigen::Index most_steps = 10 * gap.size() + 100;
  for (Eigen::Index step = 0; step < most_steps; ++step) {
    while (!press(a, gap, soft, force, b)) {
    }
    if (!force.allFinite()) return false;
    b.gap = gap;
    b.gap.noalias() += a * force;
    Eigen::Index deepest = 0;
    const double least =
        std::max(settled * gap.lpNorm<Eigen::Infinity>(), soft * force.lpNorm<Eigen::Infinity>());
    for (Eigen::Index i = 0; i < gap.size(); ++i)
      if (b.is_pressed[i]) b.gap(i) = 0.0;
    if (b.gap.minCoeff(&deepest) >= -least) return true;
    b.is_pressed[deepest] = 1;
  }
  return false;
}

}  // namespace

bool unilateral_forces(const Eigen::MatrixXd& a, const Vector& gap, Vector& force,
                       UnilateralBuffers& buffers) {
  if (!gap.allFinite() || !a.allFinite()) return false;
  buffers.is_pressed.resize(index(gap.size()));
  buffers.guess.setZero(gap.size());
  for (Eigen::Index i = 0; i < gap.size(); ++i) {
    if (i < force.size()) buffers.guess(i) = std::max(0.0, force(i));
    buffers.is_pressed[i] = gap(i) < 0.0 || buffers.guess(i) > 0.0;
  }
  force.resize(gap.size());
  if (by_active_sets(a, gap, force, buffers)) return true;
  force = buffers.guess;
  return by_rows(a, gap, softness * a.diagonal().maxCoeff(), force, buffers);
}

}  // namespace abut
