// Goal: the least displacement that opens rows. Oracles: one row in closed form; the same problem
// with a dense matrix, d = A^T f with 0 <= f _|_ gap + A A^T f >= 0.

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "subdomain_solver/solve/unilateral_forces.hpp"
#include "surface/least_opening.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::surface_least_opening_tests {
namespace {

SparseRows rows_of(const Eigen::MatrixXd& a) {
  SparseRows rows;
  rows.clear();
  for (Eigen::Index r = 0; r < a.rows(); ++r) {
    for (Eigen::Index c = 0; c < a.cols(); ++c) {
      rows.columns.push_back(static_cast<std::int32_t>(c));
      rows.values.push_back(a(r, c));
    }
    rows.end_row();
  }
  return rows;
}

TEST(LeastOpening, MovesAlongOneRowByWhatItLacks) {
  const Eigen::MatrixXd a = Eigen::RowVector3d(1.0, 2.0, -2.0);
  const SparseRows rows = rows_of(a);
  std::vector<double> d(3, 0.0);
  least_opening(rows, std::vector<double>{-0.9}, std::vector<char>{0}, 0.0, 10, d);
  for (std::size_t i = 0; i < 3; ++i)  // -gap a / |a|^2, to round-off
    EXPECT_NEAR(d[i], 0.9 * a(0, static_cast<Eigen::Index>(i)) / 9.0, roundoff(2.0, 0.2));
  std::vector<double> none(3, 0.0);
  least_opening(rows, std::vector<double>{0.9}, std::vector<char>{0}, 0.0, 10, none);
  EXPECT_EQ(none, std::vector<double>(3, 0.0));
  least_opening(rows, std::vector<double>{0.9}, std::vector<char>{1}, 0.0, 10, none);
  EXPECT_NEAR(none[0] + 2.0 * none[1] - 2.0 * none[2], -0.9, roundoff(4.0, 0.9));
}

TEST(LeastOpening, OfManyRowsIsThatOfTheDenseProblem) {
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  for (int trial = 0; trial < 20; ++trial) {
    Eigen::MatrixXd a(12, 20);
    for (double& x : a.reshaped()) x = draw(engine);
    a.row(11) = 0.5 * (a.row(3) + a.row(4));  // says what others say
    Vector gap(12);
    for (double& g : gap) g = draw(engine);
    gap(11) = 0.5 * (gap(3) + gap(4));
    Vector force;
    UnilateralBuffers buffers;
    ASSERT_TRUE(unilateral_forces(a * a.transpose(), gap, force, buffers));
    const Vector expected = a.transpose() * force;
    std::vector<double> d(20, 0.0);
    least_opening(rows_of(a), std::vector<double>(gap.begin(), gap.end()), std::vector<char>(12, 0),
                  1.0e-14, 100000, d);
    for (std::size_t i = 0; i < d.size(); ++i)
      // dependent rows share by 1e-11 there
      EXPECT_NEAR(d[i], expected(static_cast<Eigen::Index>(i)), 1.0e-9) << trial;
  }
}

}  // namespace
}  // namespace abut::surface_least_opening_tests
