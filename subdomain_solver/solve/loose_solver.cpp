#include "subdomain_solver/solve/loose_solver.hpp"

#include <algorithm>
#include <utility>

namespace abut {

LooseSolver::LooseSolver(std::unique_ptr<LinearSolver> inner, Eigen::MatrixXd motions, double give)
    : inner_(std::move(inner)), motions_(std::move(motions)), give_(give) {
  const Eigen::VectorXi order = pivot_order(motions_.transpose());
  held_.assign(order.data(), order.data() + motions_.cols());
}

bool LooseSolver::factor(const SparseMatrix& matrix) {
  const Eigen::Index n = motions_.rows(), k = motions_.cols();
  const double spring = matrix.diagonal().cwiseAbs().maxCoeff();
  if (!(spring > 0.0)) return false;
  sprung_ = matrix;
  for (const int at : held_) sprung_.coeffRef(at, at) += spring;
  if (!inner_->factor(sprung_)) return false;
  Eigen::MatrixXd columns(n, 2 * k);
  columns.leftCols(k).setZero();
  for (Eigen::Index i = 0; i < k; ++i) columns(held_[static_cast<std::size_t>(i)], i) = spring;
  columns.rightCols(k) = motions_ / static_cast<double>(n);
  if (!inner_->solve_columns(columns, answers_)) return false;
  // x = y + answers [w; -m] with w = x at the springs, and of the motions what m / s is.
  Eigen::MatrixXd closing(2 * k, 2 * k);
  closing.topRows(k) = -answers_(held_, Eigen::all);
  closing.topLeftCorner(k, k).diagonal().array() += 1.0;
  closing.bottomRows(k) = -(motions_.transpose() * answers_) / static_cast<double>(n);
  closing.bottomRightCorner(k, k).diagonal().array() -= give_of(matrix);
  closing_.compute(closing);
  return true;
}

/// A body that is pressed falls over by itself: springs below P / L do not hold it, and contact
/// finds no forces in what gives way the wrong way round. What is solved for then has springs that
/// do; the equations do not.
double LooseSolver::give_of(const SparseMatrix& matrix) const {
  if (give_ == 0.0 || !holds_up_) return give_;
  const Eigen::MatrixXd own = motions_.transpose() * (matrix * motions_);
  const double falls = -symmetric_eigenvalues(0.5 * (own + own.transpose()))(0);
  return falls > 0.0 ? std::min(give_, 0.5 / falls) : give_;
}

bool LooseSolver::solve(const Vector& b, Vector& x) {
  none_.setZero(motions_.cols());
  return solve(b, none_, x, left_);
}

bool LooseSolver::solve(const Vector& b, const Vector& a, Vector& x, Vector& m) {
  if (!inner_->solve(b, x)) return false;
  const Eigen::Index k = motions_.cols();
  values_.resize(2 * k);
  values_.head(k) = x(held_);
  values_.tail(k) = motions_.transpose() * x / static_cast<double>(motions_.rows()) - a;
  values_ = closing_.solve(values_);
  x += answers_ * values_;
  m = -values_.tail(k);
  return x.allFinite();
}

}  // namespace abut
