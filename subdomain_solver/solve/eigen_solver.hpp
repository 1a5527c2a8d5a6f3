#pragma once

#include "subdomain_solver/solve/linear_solver.hpp"

namespace abut {

/// Any of Eigen's direct sparse solvers, its own or wrapped ones.
template <class Solver>
class EigenSolver : public LinearSolver {
 public:
  [[nodiscard]] bool factor(const SparseMatrix& matrix) override {
    if (matrix.rows() == 0) return true;  // all coordinates are prescribed
    if (!analysed_) solver_.analyzePattern(matrix);
    analysed_ = true;
    solver_.factorize(matrix);
    return solver_.info() == Eigen::Success;
  }
  [[nodiscard]] bool solve(const Vector& b, Vector& x) override {
    x = b.rows() == 0 ? b : solver_.solve(b).eval();
    return x.allFinite();
  }
  [[nodiscard]] bool solve_columns(const Eigen::MatrixXd& b, Eigen::MatrixXd& x) override {
    x = b.rows() == 0 ? b : solver_.solve(b).eval();
    return x.allFinite();
  }

 protected:
  Solver solver_;

 private:
  bool analysed_ = false;
};

}  // namespace abut
