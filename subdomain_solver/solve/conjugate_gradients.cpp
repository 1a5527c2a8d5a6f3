#include <Eigen/IterativeLinearSolvers>

#include "subdomain_solver/solve/linear_solver.hpp"

namespace abut {

namespace {

class ConjugateGradients final : public LinearSolver {
 public:
  explicit ConjugateGradients(double tolerance) { solver_.setTolerance(tolerance); }

  [[nodiscard]] bool factor(const SparseMatrix& matrix) override {
    if (matrix.rows() == 0) return true;  // all coordinates are prescribed
    matrix_ = matrix;                     // the iteration refers to it
    solver_.compute(matrix_);
    return solver_.info() == Eigen::Success;
  }
  [[nodiscard]] bool solve(const Vector& b, Vector& x) override {
    if (b.rows() == 0) {
      x = b;
      return true;
    }
    x = solver_.solve(b);
    return solver_.info() == Eigen::Success && x.allFinite();
  }

 private:
  using Preconditioner = Eigen::IncompleteCholesky<double>;
  SparseMatrix matrix_;
  Eigen::ConjugateGradient<SparseMatrix, Eigen::Lower | Eigen::Upper, Preconditioner> solver_;
};

}  // namespace

std::unique_ptr<LinearSolver> make_conjugate_gradients(double tolerance) {
  return std::make_unique<ConjugateGradients>(tolerance);
}

}  // namespace abut
