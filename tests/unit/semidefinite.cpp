// Goal: equations some of which follow from others have their least answer, whatever the order of
// rows, and what contradicts them adds nothing. Oracles: the pseudo-inverse by eigenvalues.
#include "base/semidefinite.hpp"

#include <random>

#include <gtest/gtest.h>

namespace abut::semidefinite_tests {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int size = 12;

Matrix random_matrix(Eigen::Index rows, Eigen::Index columns) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  Matrix out(rows, columns);
  for (double& value : out.reshaped()) value = draw(engine);
  return out;
}

/// Of unlike compliances: rows of the first half are a thousand times as stiff.
Matrix of_rank(Eigen::Index rank) {
  Matrix half = random_matrix(size, rank);
  half.topRows(size / 2) *= 0.03;
  return half * half.transpose();
}

Matrix pseudo_inverse_of(const Matrix& matrix, Eigen::Index rank) {
  const EigenPairs pairs = symmetric_eigen(matrix);
  const Matrix own = pairs.vectors.rightCols(rank);
  return own * pairs.values.tail(rank).cwiseInverse().asDiagonal() * own.transpose();
}

/// Factors in units of the diagonal, as where all rows are alike.
SemidefiniteFactors factors_of(const Matrix& matrix) {
  SemidefiniteFactors factors;
  factors.compute(matrix, matrix.diagonal());
  return factors;
}

/// Rounding over the condition of the ranks below, some 1e5, and the share that is added where all
/// rows count.
constexpr double tolerance = 1.0e-8;

TEST(Semidefinite, AnswersAreThoseOfTheLeastSize) {
  const Matrix right = random_matrix(size, 3);
  for (const Eigen::Index rank : {3, 7, 11}) {
    const Matrix matrix = of_rank(rank);
    const SemidefiniteFactors factors = factors_of(matrix);
    EXPECT_EQ(factors.rank(), rank);
    const Matrix want = pseudo_inverse_of(matrix, rank) * right;
    EXPECT_LT((factors.solve(right) - want).norm(), tolerance * want.norm());
  }
}

TEST(Semidefinite, OfIndependentRowsTheyAreTheOnlyOnes) {
  const Matrix matrix = of_rank(size) + Matrix::Identity(size, size);
  const Vector right = random_matrix(size, 1);
  const SemidefiniteFactors factors = factors_of(matrix);
  EXPECT_EQ(factors.rank(), size);
  EXPECT_LT((matrix * factors.solve(right) - right).norm(), tolerance * right.norm());
}

// Ties of three bodies around an edge, whose nodes are in the same places up to 1e-12.
TEST(Semidefinite, WhatRoundingsLeaveOfRowsThatFollowIsNotTakenForMore) {
  const Matrix whole = of_rank(8);
  const SemidefiniteFactors exact = factors_of(whole);
  const SemidefiniteFactors rounded = factors_of(whole + 1.0e-14 * of_rank(size));
  ASSERT_EQ(rounded.rank(), 8);
  const Vector right = whole * random_matrix(size, 1);
  const Vector off = right + 1.0e-12 * Vector::Ones(size);
  const Vector want = exact.solve(right);
  EXPECT_LT((want - rounded.solve(off)).norm(), tolerance * want.norm());
}

TEST(Semidefinite, TheOrderOfRowsIsNothing) {
  const Matrix matrix = of_rank(5);
  const Vector right = random_matrix(size, 1);
  Eigen::PermutationMatrix<Eigen::Dynamic> turned(size);
  for (int i = 0; i < size; ++i) turned.indices()(i) = (5 * i + 3) % size;
  const SemidefiniteFactors one = factors_of(matrix);
  const SemidefiniteFactors other = factors_of(turned * matrix * turned.transpose());
  const Vector want = one.solve(right);
  EXPECT_LT((turned * want - other.solve(Vector(turned * right))).norm(), tolerance * want.norm());
}

// A row of held points that reaches a ten-thousandth of what is free beside them.
TEST(Semidefinite, RowsFarBelowTheirUnitsDoNotCount) {
  Matrix matrix = Matrix::Identity(2, 2);
  matrix(1, 1) = 1.0e-10;
  const Vector right = Vector::Ones(2);
  SemidefiniteFactors factors;
  factors.compute(matrix, Vector::Ones(2));
  EXPECT_EQ(factors.rank(), 1);
  EXPECT_EQ(factors.solve(right), Vector::Unit(2, 0));
  factors.compute(matrix, matrix.diagonal());
  EXPECT_EQ(factors.rank(), 2);
}

// Points that supports hold answer no force.
TEST(Semidefinite, WhatNothingMovesGetsNothing) {
  Matrix matrix = Matrix::Zero(size, size);
  matrix.topLeftCorner(4, 4) = Matrix::Identity(4, 4) + random_matrix(4, 4) * 0.1;
  matrix.topLeftCorner(4, 4) = (matrix + matrix.transpose()).eval().topLeftCorner(4, 4);
  const SemidefiniteFactors factors = factors_of(matrix);
  EXPECT_EQ(factors.rank(), 4);
  EXPECT_EQ(factors.solve(Vector(Vector::Ones(size))).tail(size - 4), Vector::Zero(size - 4));
  const SemidefiniteFactors none = factors_of(Matrix::Zero(size, size));
  EXPECT_EQ(none.rank(), 0);
  EXPECT_EQ(none.solve(Vector(Vector::Ones(size))), Vector::Zero(size));
}

}  // namespace
}  // namespace abut::semidefinite_tests
