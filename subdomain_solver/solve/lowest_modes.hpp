#pragma once

#include <functional>
#include <limits>

#include "subdomain_solver/model.hpp"

namespace abut {

/// K x = lambda M x with a symmetric, positive semidefinite K and a positive definite M.
struct Pencil {
  const SparseMatrix& stiffness;
  const SparseMatrix& mass;
  int null = 0;  // dimension of the null space of K
  /// F b, columns (n, k): the x with K x = b - M z for a z in the null space, itself M-orthogonal
  /// to the null space; x = K^-1 b when there is none.
  std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)> flexibility;
};

/// Which modes: the `count` lowest ones, or all with an eigenvalue below a bound.
struct WantedModes {
  int count = std::numeric_limits<int>::max();
  double below = std::numeric_limits<double>::infinity();
};

struct Modes {
  Vector eigenvalues;      // (k) ascending, those of the null space left out
  Eigen::MatrixXd shapes;  // (n, k) x^T M x = 1
};

/// Lowest modes by a block Lanczos method on F M that keeps all its vectors orthogonal: the block
/// finds multiple eigenvalues, as every symmetric body has them, which a single start vector finds
/// by round-off only, and not always. Where many of all modes are wanted: the dense problem.
/// Fewer modes than wanted are returned when there are no more. Same input, same bits.
Modes lowest_modes(const Pencil& pencil, const WantedModes& wanted);

}  // namespace abut
