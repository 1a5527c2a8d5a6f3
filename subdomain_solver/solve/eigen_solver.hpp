#pragma once

#include <cmath>

#include "subdomain_solver/solve/linear_solver.hpp"

namespace abut {

/// A pivot is what elimination leaves of an entry of the diagonal: the stiffness of a coordinate
/// when those before it are free to follow. Of a free body of n coordinates round-off is left, up
/// to n 2e-16 parts of the entry; a cantilever of cells in a row, held at one end, is known to
/// three digits as long as it keeps more than n 1e-15.
inline bool pivot_holds(double pivot, double diagonal, Eigen::Index coordinates) {
  const double lost = 1.0e-15 * static_cast<double>(coordinates);
  return std::abs(pivot) > lost * std::abs(diagonal);
}

/// Any of Eigen's direct sparse solvers, its own or wrapped ones, with `solve_into(b, x)` beside.
template <class Solver>
class EigenSolver : public LinearSolver {
 public:
  explicit EigenSolver(Pivots pivots) : pivots_(pivots) {}

  [[nodiscard]] bool factor(const SparseMatrix& matrix) override {
    if (matrix.rows() == 0) return true;  // all coordinates are prescribed
    if (!analysed_) solver_.analyzePattern(matrix);
    analysed_ = true;
    solver_.factorize(matrix);
    if (solver_.info() != Eigen::Success) return false;
    if (pivots_ == Pivots::every) return true;
    diagonal_ = matrix.diagonal();
    return pivots_hold(diagonal_);
  }
  [[nodiscard]] bool solve(const Vector& b, Vector& x) override {
    x.resize(b.rows());
    if (b.rows() > 0) solver_.solve_into(b, x);
    return x.allFinite();
  }
  [[nodiscard]] bool solve_columns(const Eigen::MatrixXd& b, Eigen::MatrixXd& x) override {
    x = b.rows() == 0 ? b : solver_.solve(b).eval();
    return x.allFinite();
  }

 protected:
  /// Whether the pivots of the last factorisation are those that are taken, which are not all.
  virtual bool pivots_hold(const Vector& diagonal) const = 0;

  Solver solver_;
  Pivots pivots_;

 private:
  Vector diagonal_;
  bool analysed_ = false;
};

}  // namespace abut
