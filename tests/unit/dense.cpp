// Goal: decompositions of dense matrices are what their names say. Oracles: their definitions, with
// matrices of small integers or random ones; rounding of the order of the matrix's size.
#include "base/dense.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace abut::dense_tests {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Sums of ten products of numbers of order 1, over a condition of some hundred.
constexpr double rounding = 1.0e-12;

Matrix random_matrix(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  Matrix out(rows, columns);
  for (double& value : out.reshaped()) value = draw(engine);
  return out;
}

/// Eigenvalues between 1 and some ten.
Matrix definite_matrix(Eigen::Index rows, unsigned seed) {
  const Matrix half = random_matrix(rows, rows, seed);
  return Matrix::Identity(rows, rows) + half * half.transpose();
}

double error(const Matrix& a, const Matrix& b) { return (a - b).cwiseAbs().maxCoeff(); }

TEST(Dense, EigenvaluesAscendAndPairsSolveTheirProblems) {
  const Matrix a = random_matrix(7, 7, 1) + random_matrix(7, 7, 1).transpose();
  const Matrix b = definite_matrix(7, 2);
  const EigenPairs own = symmetric_eigen(a), both = generalized_eigen(a, b);
  EXPECT_LT(error(a * own.vectors, own.vectors * own.values.asDiagonal()), rounding);
  EXPECT_LT(error(a * both.vectors, b * both.vectors * both.values.asDiagonal()), rounding);
  EXPECT_TRUE(std::is_sorted(own.values.begin(), own.values.end()));
  EXPECT_LT(error(own.values, symmetric_eigenvalues(a)), rounding);
  EXPECT_LT(error(both.values, generalized_eigenvalues(a, b)), rounding);
}

TEST(Dense, OfASymmetricMatrixTheLowerHalfIsRead) {
  Matrix a(2, 2);
  a << 2.0, 1.0e3, 1.0, 2.0;
  EXPECT_LT(error(symmetric_eigenvalues(a), Vector{{1.0, 3.0}}), rounding);
}

TEST(Dense, SingularValuesAndVectorsMakeTheMatrix) {
  const Matrix a = random_matrix(6, 4, 3);
  const SingularValues parts = singular_values(a, SingularVectors::both);
  EXPECT_LT(error(parts.u.leftCols(4) * parts.values.asDiagonal() * parts.v.transpose(), a),
            rounding);
  EXPECT_EQ(parts.u.cols(), 6);
  EXPECT_TRUE(std::is_sorted(parts.values.begin(), parts.values.end(), std::greater<>()));
  EXPECT_EQ(singular_values(a, SingularVectors::none).v.size(), 0);
  EXPECT_EQ(singular_values(a, SingularVectors::right).u.size(), 0);
}

TEST(Dense, OrthogonalColumnsSpanTheMatrix) {
  const Matrix a = random_matrix(6, 3, 4), q = orthogonal_columns(a);
  EXPECT_LT(error(q.transpose() * q, Matrix::Identity(3, 3)), rounding);
  EXPECT_LT(error(q * (q.transpose() * a), a), rounding);
}

TEST(Dense, PivotsTakeTheLargestColumnFirstAndDependentOnesLast) {
  Matrix a(2, 3);
  a << 1.0, 5.0, 2.0, 0.0, 0.0, 1.0;
  EXPECT_EQ(pivot_order(a), (Eigen::VectorXi{{1, 2, 0}}));
}

TEST(Dense, LeastSquaresLeaveARestAtRightAngles) {
  const Matrix a = random_matrix(8, 3, 5), right = random_matrix(8, 2, 6);
  const Vector one = right.col(0);
  EXPECT_LT(error(a.transpose() * (right - a * least_squares(a, right)), Matrix::Zero(3, 2)),
            rounding);
  EXPECT_LT(error(a.transpose() * (one - a * least_squares(a, one)), Vector::Zero(3)), rounding);
  EXPECT_LT(error(a.transpose() * (one - a * qr_solve(a, one)), Vector::Zero(3)), rounding);
}

TEST(Dense, ThePseudoInverseOfADependentMatrixIsOfLeastSize) {
  const Matrix a = Matrix::Ones(2, 2);  // its pseudo-inverse is a / 4
  EXPECT_LT(error(pseudo_inverse(a, 1.0e-10), a / 4.0), rounding);
}

TEST(Dense, EverySolverSolves) {
  const Matrix a = definite_matrix(5, 7), square = random_matrix(5, 5, 8) + 3.0 * a;
  const Matrix right = random_matrix(5, 2, 9);
  const Vector one = right.col(1);
  EXPECT_LT(error(a * solve_symmetric(a, right), right), rounding);
  EXPECT_LT(error(a * solve_symmetric(a, one), one), rounding);
  EXPECT_LT(error(square * solve_square(square, right), right), rounding);
  EXPECT_LT(error(square * solve_square(square, one), one), rounding);
  EXPECT_LT(error(square * inverse_of(square), Matrix::Identity(5, 5)), rounding);
  for (const Factoring kind : {Factoring::lu, Factoring::cholesky, Factoring::ldlt}) {
    DenseFactors factors(kind);
    ASSERT_TRUE(factors.compute(a));
    Vector x;
    factors.solve(one, x);
    EXPECT_LT(error(a * x, one), rounding);
    EXPECT_EQ(factors.solve(one), x);
    EXPECT_LT(error(a * factors.solve(right), right), rounding);
  }
}

TEST(Dense, WhatIsNotDefiniteIsTold) {
  Matrix a = Matrix::Identity(3, 3), its = 4.0 * a;
  EXPECT_TRUE(factor_definite(its));
  EXPECT_EQ(its, 2.0 * a) << "factors take its place";
  a(2, 2) = its(2, 2) = -1.0;
  EXPECT_FALSE(factor_definite(its));
  EXPECT_FALSE(DenseFactors(Factoring::cholesky).compute(a));
  EXPECT_TRUE(DenseFactors(Factoring::ldlt).compute(a));
}

TEST(Dense, PivotsOfLuMultiplyToTheDeterminant) {
  Matrix a(2, 2);
  a << 1.0, 2.0, 3.0, 4.0;  // determinant -2
  DenseFactors factors(Factoring::lu);
  ASSERT_TRUE(factors.compute(a));
  EXPECT_NEAR(std::abs(factors.pivots().prod()), 2.0, rounding);
  EXPECT_NEAR(determinant_of(a), -2.0, rounding);
}

// Bits of products depend on how sums are cut into parts, which Eigen does by the caches that it
// believes in (cmake/floating_point.cmake).
TEST(Dense, SumsAreCutAlikeOnAllMachines) {
  EXPECT_EQ(Eigen::l1CacheSize(), 32768);
  EXPECT_EQ(Eigen::l2CacheSize(), 1048576);
  EXPECT_EQ(Eigen::l3CacheSize(), 33554432);
}

}  // namespace
}  // namespace abut::dense_tests
