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
  closing.bottomRightCorner(k, k).diagonal().array() -= give_of(closing);
  closing_.compute(closing);
  return true;
}

/// A body that is pressed falls over by itself: springs below P / L do not hold it, and contact
/// finds no forces in what gives way the wrong way round. What is solved for then has springs that
/// do; the equations do not. `rigid`: the closing matrix of what does not give way.
double LooseSolver::give_of(const Eigen::MatrixXd& rigid) {
  falling_.stiffness = 0.0;
  if (give_ == 0.0 || !holds_up_) return give_;
  const Eigen::Index k = motions_.cols();
  // m = -S a: S (k, k) [N/m] answers along the motions while the rest of the body is in balance,
  // which a turned body that is deformed is not, so that R^T K R / n^2 alone may look firm.
  Eigen::MatrixXd places = Eigen::MatrixXd::Zero(2 * k, k);
  places.bottomRows(k).diagonal().setOnes();
  const Eigen::MatrixXd stands = -solve_square(rigid, places).bottomRows(k);
  if (!stands.allFinite()) return give_;
  const EigenPairs own = symmetric_eigen(0.5 * (stands + stands.transpose()));
  if (own.values(0) < 0.0) falling_ = {-own.values(0), own.vectors.col(0)};
  const double stiffest = std::max(stiffer_, 2.0 * falling_.stiffness);
  return stiffest > 0.0 ? std::min(give_, 1.0 / stiffest) : give_;
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
