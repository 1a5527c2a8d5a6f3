#pragma once

#include <Eigen/Core>

#include "base/dense.hpp"

namespace abut {

/// Factors of a symmetric positive semidefinite matrix A; some of its rows may follow from others.
/// What equations contradict each other in, and what any x fulfils, have no part in an answer: x is
/// the least of those for which A x is nearest to the right side.
///
/// Cholesky factors with pivots, in units of each row: rows of which less than 1e-8 of one remains
/// follow from those before. With A = L L^T so far, x = L (L^T L)^-2 L^T right, whatever the
/// pivots: an answer does not jump where two of them are as large. N. J. Higham, Accuracy and
/// Stability of Numerical Algorithms, 2002, section 10.3.
class SemidefiniteFactors {
 public:
  /// `units`: (rows) what diagonals usually are there. Where no row follows from others, x is that
  /// of A + 1e-10 of the largest diagonal.
  void compute(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& units);
  Eigen::Index rank() const { return rank_; }
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;

 private:
  void find_rows(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& units);

  Eigen::Index rank_ = 0;
  bool whole_ = true;                        // no row follows from others
  Eigen::MatrixXd lower_;                    // L (rows, rank), otherwise
  DenseFactors factors_{Factoring::ldlt};    // of all rows
  DenseFactors inner_{Factoring::cholesky};  // of L^T L
};

}  // namespace abut
