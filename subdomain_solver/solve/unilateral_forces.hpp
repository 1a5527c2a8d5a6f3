#pragma once

#include <vector>

#include "base/dense.hpp"
#include "subdomain_solver/model.hpp"

namespace abut {

/// Memory that calls use again; its contents mean nothing between them.
struct UnilateralBuffers {
  std::vector<Eigen::Index> pressed;
  std::vector<char> is_pressed;
  Eigen::MatrixXd part;
  Vector rest, answer, gap, guess, from;
  DenseFactors factors{Factoring::cholesky};
};

/// The forces of one-sided rows:  0 <= f _|_ gap + A f >= 0,  A [m/N] symmetric and positive
/// definite, or with rows that say the same. Begins with `force`, as far as it fits, as a guess of
/// which rows press; leaves the answer there. The primal-dual active set (Hintermueller, Ito,
/// Kunisch 2002: Newton's method) and, where that goes round in circles or rows depend on each
/// other, one row after the other. False: neither came to an end.
[[nodiscard]] bool unilateral_forces(const Eigen::MatrixXd& a, const Vector& gap, Vector& force,
                                     UnilateralBuffers& buffers);

}  // namespace abut
