// Goal: PETSc answers as factors do. Oracle: the direct solver.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "subdomain_solver/solve/linear_solver.hpp"
#include "subdomain_solver/solve/petsc_solver.hpp"

namespace abut::solve_petsc {
namespace {

/// Springs between neighbours of a grid of n x n points, and to the ground.
SparseMatrix springs(int n, double ground) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto join = [&](int a, int b) {
    entries.insert(entries.end(), {{a, a, 1.0}, {b, b, 1.0}, {a, b, -1.0}, {b, a, -1.0}});
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int here = i * n + j;
      entries.emplace_back(here, here, ground);
      if (i + 1 < n) join(here, here + n);
      if (j + 1 < n) join(here, here + 1);
    }
  SparseMatrix matrix(n * n, n * n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

TEST(Petsc, AnswersAsFactorsDo) {
  if (!has_petsc()) {
    EXPECT_EQ(make_petsc_solver(1.0e-10), nullptr);
    GTEST_SKIP() << "a build without PETSc";
  }
  const auto iterated = make_petsc_solver(1.0e-10), factored = make_direct_solver();
  for (const double ground : {1.0, 1.0e-3}) {  // the same object, another matrix
    const SparseMatrix matrix = springs(40, ground);
    ASSERT_TRUE(iterated->factor(matrix));
    ASSERT_TRUE(factored->factor(matrix));
    Vector b(matrix.rows()), x, y;
    for (Eigen::Index k = 0; k < b.size(); ++k) b(k) = std::sin(3.0 * static_cast<double>(k));
    for (int again = 0; again < 2; ++again, b *= -3.0) {
      ASSERT_TRUE(iterated->solve(b, x));
      ASSERT_TRUE(factored->solve(b, y));
      // The residual, 1e-10 of b, over the least eigenvalue.
      EXPECT_LT((x - y).norm(), 1.0e-10 * b.norm() / ground * 10.0);
    }
  }
}

TEST(Petsc, HasNoAnswerWhereThereIsNone) {
  if (!has_petsc()) GTEST_SKIP() << "a build without PETSc";
  const auto solver = make_petsc_solver(1.0e-10);
  SparseMatrix matrix = springs(10, 1.0);
  Vector b = Vector::Ones(matrix.rows()), x;
  ASSERT_TRUE(solver->factor(matrix));
  b(7) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(solver->solve(b, x));
  b.setOnes();
  matrix.coeffRef(3, 3) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(solver->factor(matrix));
  matrix = springs(10, 0.0);  // nothing holds it, and the forces are not in balance
  EXPECT_FALSE(solver->factor(matrix) && solver->solve(b, x));
  ASSERT_TRUE(solver->factor(springs(10, 1.0)));
  EXPECT_TRUE(solver->solve(Vector::Zero(100), x));
  EXPECT_EQ(x, Vector::Zero(100));
}

}  // namespace
}  // namespace abut::solve_petsc
