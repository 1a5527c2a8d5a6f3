// Goal: forces of one-sided rows are found, also where rows say the same.
// Oracle: the conditions themselves, f >= 0, g >= 0, f g = 0, which have one gap for a given
// matrix.

#include <random>

#include <gtest/gtest.h>

#include "subdomain_solver/solve/unilateral_forces.hpp"

namespace abut::solve_unilateral_tests {
namespace {

void check(const Eigen::MatrixXd& a, const Vector& gap, const Vector& force, double tolerance) {
  const Vector left = gap + a * force;
  const double length = gap.lpNorm<Eigen::Infinity>();
  for (Eigen::Index i = 0; i < gap.size(); ++i) {
    EXPECT_GE(force(i), 0.0);
    EXPECT_GE(left(i), -tolerance * length);
    EXPECT_NEAR(force(i) * left(i), 0.0, tolerance * length * force.lpNorm<Eigen::Infinity>());
  }
}

TEST(UnilateralForces, MeetTheirConditions) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  UnilateralBuffers buffers;  // used again, as between substeps
  Vector force;
  for (int n = 1; n <= 40; ++n) {
    for (int trial = 0; trial < 20; ++trial) {
      Eigen::MatrixXd b(n, n);
      for (Eigen::Index k = 0; k < b.size(); ++k) b.data()[k] = normal(random);
      const Eigen::MatrixXd a =
          b * b.transpose() + 0.1 * n * Eigen::MatrixXd::Identity(n, n);  // condition below 1e3
      Vector gap(n);
      for (Eigen::Index k = 0; k < n; ++k) gap(k) = normal(random);
      ASSERT_TRUE(unilateral_forces(a, gap, force, buffers));
      check(a, gap, force, 1.0e-11);
    }
  }
}

TEST(UnilateralForces, OfRowsThatSayTheSameCloseTheirGap) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Constant(3, 3, 2.0);
  a(2, 2) = 3.0;
  const Vector gap = Vector::Constant(3, -1.0);
  Vector force;
  UnilateralBuffers buffers;
  ASSERT_TRUE(unilateral_forces(a, gap, force, buffers));
  check(a, gap, force, 1.0e-11);
}

/// More rows than there is to move: a finer surface on a coarser one, before what cannot give way.
TEST(UnilateralForces, OfRowsThatDependOnEachOtherCloseTheirGaps) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  UnilateralBuffers buffers;
  for (int trial = 0; trial < 50; ++trial) {
    const int moves = 3 + trial % 8, rows = 3 * moves;
    Eigen::MatrixXd b(rows, moves);
    for (Eigen::Index k = 0; k < b.size(); ++k) b.data()[k] = part(random);
    Vector gap(rows), force;
    const Vector deep = Vector::Constant(moves, -1.0);  // every row can be closed
    for (Eigen::Index k = 0; k < rows; ++k)
      gap(k) = b.row(k).dot(deep) + static_cast<double>(k % 3) * part(random);
    const Eigen::MatrixXd a = b * b.transpose();
    ASSERT_TRUE(unilateral_forces(a, gap, force, buffers));
    check(a, gap, force, 1.0e-8);  // rows share their force by 1e-11 of the compliance
  }
}

TEST(UnilateralForces, OfOpenRowsAreNone) {
  Vector force = Vector::Constant(2, 5.0);  // a guess that is wrong
  UnilateralBuffers buffers;
  const Eigen::MatrixXd a = Eigen::MatrixXd::Identity(2, 2);
  ASSERT_TRUE(unilateral_forces(a, Vector::Constant(2, 1.0), force, buffers));
  EXPECT_EQ(force, Vector::Zero(2));
}

TEST(UnilateralForces, OfWhatIsNotFiniteAreNotFound) {
  Vector force, gap = Vector::Constant(2, -1.0);
  gap(1) = std::numeric_limits<double>::quiet_NaN();
  UnilateralBuffers buffers;
  EXPECT_FALSE(unilateral_forces(Eigen::MatrixXd::Identity(2, 2), gap, force, buffers));
}

}  // namespace
}  // namespace abut::solve_unilateral_tests
