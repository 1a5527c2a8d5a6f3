#include <Eigen/IterativeLinearSolvers>

#include "base/index.hpp"
#include "subdomain_solver/solve/linear_solver.hpp"
#include "subdomain_solver/solve/multigrid.hpp"

namespace abut {

namespace {

class IncompleteFactors {
 public:
  bool factor(const SparseMatrix& matrix) {
    factors_.compute(matrix);
    return factors_.info() == Eigen::Success;
  }
  void apply(const Vector& r, Vector& z) const { z = factors_.solve(r); }

 private:
  Eigen::IncompleteCholesky<double> factors_;
};

class ConjugateGradients final : public LinearSolver {
 public:
  ConjugateGradients(double tolerance, CoarseMotions motions)
      : tolerance_(tolerance), motions_(std::move(motions)) {}

  [[nodiscard]] bool factor(const SparseMatrix& matrix) override {
    matrix_ = matrix;
    if (matrix.rows() == 0) return true;  // all coordinates are prescribed
    if (matrix.rows() != motions_.motions.rows()) return incomplete_.factor(matrix);
    if (!multigrid_) multigrid_ = std::make_unique<Multigrid>(motions_);
    return multigrid_->factor(matrix);
  }

  [[nodiscard]] bool solve(const Vector& b, Vector& x) override {
    x.setZero(b.rows());
    const double enough = tolerance_ * b.norm();
    r_ = b;
    double before = 0.0;  // r.z
    for (Eigen::Index k = 0; k < 2 * b.rows() + 1; ++k) {
      const double left = r_.norm();
      if (!std::isfinite(left)) return false;
      if (left <= enough) return x.allFinite();
      apply();
      const double now = r_.dot(z_);
      if (!(now > 0.0)) return false;
      if (k == 0) {
        p_ = z_;
      } else {
        p_ = z_ + (now / before) * p_;
      }
      before = now;
      q_.noalias() = matrix_ * p_;
      const double stiffness = p_.dot(q_);
      if (!(stiffness > 0.0)) return false;  // not positive definite
      x += (now / stiffness) * p_;
      r_ -= (now / stiffness) * q_;
    }
    return false;
  }

 private:
  void apply() {
    if (multigrid_) return multigrid_->apply(r_, z_);
    incomplete_.apply(r_, z_);
  }

  double tolerance_;
  CoarseMotions motions_;
  SparseMatrix matrix_;
  IncompleteFactors incomplete_;
  std::unique_ptr<Multigrid> multigrid_;  // null: incomplete factors
  Vector r_, z_, p_, q_;                  // of an iteration
};

}  // namespace

std::unique_ptr<LinearSolver> make_conjugate_gradients(double tolerance, CoarseMotions motions) {
  return std::make_unique<ConjugateGradients>(tolerance, std::move(motions));
}

}  // namespace abut
