#include "base/semidefinite.hpp"

#include <algorithm>
#include <cmath>

namespace abut {

namespace {

/// Of the largest diagonal: is added where all rows count.
constexpr double little = 1.0e-10;
/// Of a unit: what remains of a row that follows from others.
constexpr double remains = 1.0e-8;
/// Times what was added: pivots that are larger are of rows that do not follow from others.
constexpr double surely = 1.0e4;

}  // namespace

void SemidefiniteFactors::compute(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& units) {
  rank_ = matrix.rows();
  whole_ = true;
  if (rank_ == 0) return;
  const double added = little * matrix.diagonal().maxCoeff();
  Eigen::MatrixXd regular = matrix;
  regular.diagonal().array() += added;
  factors_.compute(regular);
  if (factors_.pivots().minCoeff() > surely * added) return;
  find_rows(matrix, units);
  whole_ = rank_ == matrix.rows();
  if (!whole_) inner_.compute(lower_.transpose() * lower_);
}

/// L, a column for each row that is found to count, the most independent one first.
void SemidefiniteFactors::find_rows(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& units) {
  const Eigen::Index size = matrix.rows();
  Eigen::ArrayXd scale(size), left(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    scale(i) = units(i) > 0.0 ? 1.0 / std::sqrt(units(i)) : 0.0;
    left(i) = matrix(i, i) * scale(i) * scale(i);
  }
  lower_.setZero(size, size);
  for (rank_ = 0; rank_ < size; ++rank_) {
    Eigen::Index pivot = 0;
    if (!(left.maxCoeff(&pivot) > remains)) break;
    auto column = lower_.col(rank_);
    column = (matrix.col(pivot).array() * scale * scale(pivot)).matrix();
    column.noalias() -= lower_.leftCols(rank_) * lower_.row(pivot).head(rank_).transpose();
    column /= std::sqrt(left(pivot));
    left -= column.array().square();
    left(pivot) = 0.0;
  }
  lower_.conservativeResize(size, rank_);
  for (Eigen::Index i = 0; i < size; ++i) lower_.row(i) *= scale(i) > 0.0 ? 1.0 / scale(i) : 0.0;
}

Eigen::VectorXd SemidefiniteFactors::solve(const Eigen::VectorXd& right) const {
  return solve(Eigen::MatrixXd(right)).col(0);
}

Eigen::MatrixXd SemidefiniteFactors::solve(const Eigen::MatrixXd& right) const {
  if (right.rows() == 0 || rank_ == 0) return Eigen::MatrixXd::Zero(right.rows(), right.cols());
  if (whole_) return factors_.solve(right);
  return lower_ * inner_.solve(inner_.solve(Eigen::MatrixXd(lower_.transpose() * right)));
}

}  // namespace abut
