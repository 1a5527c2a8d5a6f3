#include "subdomain_solver/solve/linear_solver.hpp"

#include <Eigen/SparseCholesky>

#include "subdomain_solver/solve/cholmod_solver.hpp"
#include "subdomain_solver/solve/eigen_solver.hpp"

namespace abut {

namespace {

class Ldlt final : public EigenSolver<Eigen::SimplicialLDLT<SparseMatrix>> {
 public:
  using EigenSolver::EigenSolver;

 private:
  bool pivots_hold(const Vector& diagonal) const override {
    const Vector pivots = solver_.vectorD();
    const auto& place = solver_.permutationP().indices();
    for (Eigen::Index i = 0; i < diagonal.size(); ++i)
      if (!pivot_holds(pivots(place(i)), diagonal(i), diagonal.size())) return false;
    return true;
  }
};

/// Supernodal factors while the matrix is positive definite; past a buckling load, for instance,
/// it is not, and the simplicial LDL^T takes over.
class FirstThatFactors final : public LinearSolver {
 public:
  FirstThatFactors(std::unique_ptr<LinearSolver> quick, Pivots pivots)
      : quick_(std::move(quick)), general_(pivots) {}

  [[nodiscard]] bool factor(const SparseMatrix& matrix) override {
    definite_ = quick_->factor(matrix);
    return definite_ || general_.factor(matrix);
  }
  [[nodiscard]] bool solve(const Vector& b, Vector& x) override {
    return definite_ ? quick_->solve(b, x) : general_.solve(b, x);
  }
  [[nodiscard]] bool solve_columns(const Eigen::MatrixXd& b, Eigen::MatrixXd& x) override {
    return definite_ ? quick_->solve_columns(b, x) : general_.solve_columns(b, x);
  }

 private:
  std::unique_ptr<LinearSolver> quick_;
  Ldlt general_;
  bool definite_ = true;
};

}  // namespace

bool LinearSolver::solve_columns(const Eigen::MatrixXd& b, Eigen::MatrixXd& x) {
  x.resize(b.rows(), b.cols());
  Vector one;
  for (Eigen::Index k = 0; k < b.cols(); ++k) {
    if (!solve(b.col(k), one)) return false;
    x.col(k) = one;
  }
  return true;
}

std::unique_ptr<LinearSolver> make_direct_solver(Pivots pivots) {
  if (std::unique_ptr<LinearSolver> quick = make_cholmod_solver(pivots); quick != nullptr)
    return std::make_unique<FirstThatFactors>(std::move(quick), pivots);
  return std::make_unique<Ldlt>(pivots);
}

}  // namespace abut
