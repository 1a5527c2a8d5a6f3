#include "subdomain_solver/solve/unilateral_forces.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"

namespace abut {

namespace {

constexpr int most_sets = 30;
constexpr int most_sweeps = 20000;
/// Of the largest force, or of the largest gap: changes below it are rounding.
constexpr double settled = 1.0e-14;

/// Forces of the pressed rows that close their gaps. False: the rows are not independent.
bool close(const Eigen::MatrixXd& a, const Vector& gap, Vector& force, UnilateralBuffers& b) {
  const Eigen::Index n = static_cast<Eigen::Index>(b.pressed.size());
  force.setZero();
  if (n == 0) return true;
  b.part.resize(n, n);
  b.rest.resize(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index column = b.pressed[index(k)];
    for (Eigen::Index i = 0; i < n; ++i) b.part(i, k) = a(b.pressed[index(i)], column);
    b.rest(k) = -gap(column);
  }
  b.factors.compute(b.part);
  if (b.factors.info() != Eigen::Success) return false;
  b.factors.solveInPlace(b.rest);
  if (!b.rest.allFinite()) return false;
  for (Eigen::Index k = 0; k < n; ++k) force(b.pressed[index(k)]) = b.rest(k);
  return true;
}

bool by_active_sets(const Eigen::MatrixXd& a, const Vector& gap, Vector& force,
                    UnilateralBuffers& b) {
  const double least = settled * gap.lpNorm<Eigen::Infinity>();
  for (int set = 0; set < most_sets; ++set) {
    b.pressed.clear();
    for (Eigen::Index i = 0; i < gap.size(); ++i)
      if (b.is_pressed[index(i)]) b.pressed.push_back(i);
    if (!close(a, gap, force, b)) return false;
    b.gap = gap;
    b.gap.noalias() += a * force;
    bool same = true;
    for (Eigen::Index i = 0; i < gap.size(); ++i) {
      const char before = b.is_pressed[index(i)];
      b.is_pressed[index(i)] = before ? force(i) > 0.0 : b.gap(i) < -least;
      same = same && before == b.is_pressed[index(i)];
    }
    if (same) return true;
  }
  return false;
}

bool by_sweeps(const Eigen::MatrixXd& a, const Vector& gap, Vector& force) {
  for (Eigen::Index i = 0; i < force.size(); ++i) force(i) = std::max(0.0, force(i));
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double change = 0.0;
    for (Eigen::Index i = 0; i < gap.size(); ++i) {
      const double open = gap(i) + a.col(i).dot(force);
      const double next = std::max(0.0, force(i) - open / a(i, i));
      change = std::max(change, std::abs(next - force(i)));
      force(i) = next;
    }
    if (!std::isfinite(change)) return false;
    if (change <= settled * force.lpNorm<Eigen::Infinity>()) return true;
  }
  return false;
}

}  // namespace

bool unilateral_forces(const Eigen::MatrixXd& a, const Vector& gap, Vector& force,
                       UnilateralBuffers& buffers) {
  if (!gap.allFinite() || !a.allFinite()) return false;
  buffers.is_pressed.resize(index(gap.size()));
  for (Eigen::Index i = 0; i < gap.size(); ++i)
    buffers.is_pressed[index(i)] = gap(i) < 0.0 || (i < force.size() && force(i) > 0.0);
  force.resize(gap.size());
  return by_active_sets(a, gap, force, buffers) || by_sweeps(a, gap, force);
}

}  // namespace abut
