// Goal: the lowest modes of symmetric pencils, multiple and zero eigenvalues included.
// Oracle: lattices of unit masses and springs, whose eigenvalues are sums of 2 - 2 cos.
#include "subdomain_solver/solve/lowest_modes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "subdomain_solver/solve/linear_solver.hpp"
#include "subdomain_solver/solve/orthonormal.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solve_lowest_modes_tests {
namespace {

/// n x n x n points, each joined to its six neighbours, the outermost to a wall.
SparseMatrix lattice(int n) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto at = [n](int i, int j, int k) { return (i * n + j) * n + k; };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        entries.emplace_back(at(i, j, k), at(i, j, k), 6.0);
        const int beside[3][3] = {{i + 1, j, k}, {i, j + 1, k}, {i, j, k + 1}};
        for (const auto& b : beside) {
          if (std::max({b[0], b[1], b[2]}) == n) continue;
          entries.emplace_back(at(i, j, k), at(b[0], b[1], b[2]), -1.0);
          entries.emplace_back(at(b[0], b[1], b[2]), at(i, j, k), -1.0);
        }
      }
    }
  }
  SparseMatrix out(n * n * n, n * n * n);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

std::vector<double> lattice_eigenvalues(int n) {
  std::vector<double> out;
  const auto one = [n](int k) { return 2.0 - 2.0 * std::cos(k * std::numbers::pi / (n + 1)); };
  for (int i = 1; i <= n; ++i) {
    for (int j = 1; j <= n; ++j) {
      for (int k = 1; k <= n; ++k) out.push_back(one(i) + one(j) + one(k));
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

SparseMatrix unit_mass(int n) {
  SparseMatrix mass(n, n);
  mass.setIdentity();
  return mass;
}

struct Lattice {
  explicit Lattice(int n)
      : points(n * n * n),
        stiffness(lattice(n)),
        mass(unit_mass(points)),
        exact(lattice_eigenvalues(n)) {
    EXPECT_TRUE(solver->factor(stiffness));
  }
  Modes modes(const WantedModes& wanted) const {
    return lowest_modes({stiffness, mass, 0,
                         [this](const Eigen::MatrixXd& b) {
                           Eigen::MatrixXd x = b;
                           for (Eigen::Index k = 0; k < b.cols(); ++k) {
                             Vector one;
                             EXPECT_TRUE(solver->solve(b.col(k), one));
                             x.col(k) = one;
                           }
                           return x;
                         }},
                        wanted);
  }

  int points;
  SparseMatrix stiffness, mass;
  std::vector<double> exact;
  std::unique_ptr<LinearSolver> solver = make_direct_solver();
};

void expect_modes(const Lattice& lattice, const Modes& modes, int count) {
  ASSERT_EQ(modes.eigenvalues.size(), count);
  if (count == 0) return;
  const Eigen::Index n = modes.shapes.cols();
  for (int k = 0; k < count; ++k) {
    // Errors are squares of residuals of 1e-9; what is left is the round-off of 1/lambda, which is
    // that of the largest one, 1/lambda_1 < 10: lambda < 12 magnifies it by 120 in relative terms.
    const double exact = lattice.exact[k];
    EXPECT_NEAR(modes.eigenvalues(k), exact, roundoff(1.0e4, exact)) << k;
  }
  const Eigen::MatrixXd gram = modes.shapes.transpose() * modes.shapes;
  EXPECT_LT((gram - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(), roundoff(1.0e3, 1.0));
  const Eigen::MatrixXd residual =
      lattice.stiffness * modes.shapes - modes.shapes * modes.eigenvalues.asDiagonal();
  // F r with |F r| below 1e-9 / lambda, times K of norm 12, times lambda < 12.
  EXPECT_LT(residual.colwise().norm().maxCoeff(), 12.0 * 12.0 * 1.0e-9);
}

class NumberOfModes : public testing::TestWithParam<int> {};

TEST_P(NumberOfModes, EveryCopyOfAMultipleEigenvalueIsFound) {
  const Lattice lattice(14);  // nearly all eigenvalues are triple or sixfold
  expect_modes(lattice, lattice.modes({GetParam()}), GetParam());
}
INSTANTIATE_TEST_SUITE_P(Of2744, NumberOfModes, testing::Values(1, 4, 10, 20, 40, 70));

TEST(LowestModes, AllBelowABound) {
  const Lattice lattice(12);
  for (const double bound : {0.1, 0.3, 0.9}) {
    const int count =
        static_cast<int>(std::lower_bound(lattice.exact.begin(), lattice.exact.end(), bound) -
                         lattice.exact.begin());
    WantedModes wanted;
    wanted.below = bound;
    expect_modes(lattice, lattice.modes(wanted), count);
  }
}

TEST(LowestModes, AllOfASmallProblem) {
  const Lattice lattice(5);
  expect_modes(lattice, lattice.modes({125}), 125);
  expect_modes(lattice, lattice.modes({1000}), 125);  // there are no more
}

TEST(LowestModes, SameInputSameBits) {
  const Lattice lattice(9);
  const Modes once = lattice.modes({12}), again = lattice.modes({12});
  EXPECT_EQ(once.eigenvalues, again.eigenvalues);
  EXPECT_EQ(once.shapes, again.shapes);
}

/// A chain of n masses, both ends free, held at the first one to find what a force does.
TEST(LowestModes, ANullSpaceIsLeftOut) {
  constexpr int n = 300;
  SparseMatrix stiffness(n, n);
  for (int i = 0; i + 1 < n; ++i) {
    stiffness.coeffRef(i, i) += 1.0;
    stiffness.coeffRef(i + 1, i + 1) += 1.0;
    stiffness.coeffRef(i, i + 1) = stiffness.coeffRef(i + 1, i) = -1.0;
  }
  stiffness.makeCompressed();
  const SparseMatrix mass = unit_mass(n);
  const std::unique_ptr<LinearSolver> solver = make_direct_solver();
  ASSERT_TRUE(solver->factor(stiffness.bottomRightCorner(n - 1, n - 1)));
  const auto flexibility = [&solver](const Eigen::MatrixXd& b) {
    Eigen::MatrixXd x = Eigen::MatrixXd::Zero(n, b.cols());
    for (Eigen::Index k = 0; k < b.cols(); ++k) {
      Vector one;
      const Vector balanced = (b.col(k).array() - b.col(k).mean()).tail(n - 1);
      EXPECT_TRUE(solver->solve(balanced, one));
      x.col(k).tail(n - 1) = one;
      x.col(k).array() -= x.col(k).mean();
    }
    return x;
  };
  for (const int count : {20, n}) {  // by blocks, and densely
    const Modes modes = lowest_modes({stiffness, mass, 1, flexibility}, {count});
    ASSERT_EQ(modes.eigenvalues.size(), std::min(count, n - 1));
    for (int k = 1; k <= modes.eigenvalues.size(); ++k) {
      // Round-off of the matrix's largest eigenvalue, 4, when it is found densely.
      EXPECT_NEAR(modes.eigenvalues(k - 1), 2.0 - 2.0 * std::cos(k * std::numbers::pi / n),
                  roundoff(n, 4.0));
    }
    // A shape holds as much of the null space as round-off of the matrix turns it by, over the gap
    // to the lowest eigenvalue (for the dense problem; by blocks there is none); 17 = sqrt(n).
    EXPECT_LT(modes.shapes.colwise().sum().cwiseAbs().maxCoeff(),
              17.0 * roundoff(4.0, 4.0 / modes.eigenvalues(0)));
  }
}

TEST(Orthonormal, DropsWhatDependsOnOthers) {
  SparseMatrix mass = 3.0 * unit_mass(40);
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(40, 4);
  x.col(0).setOnes();
  x.col(1).setLinSpaced(0.0, 2.0);
  x.col(2) = 2.0 * x.col(0) - x.col(1);
  x(7, 3) = 1.0e-3;
  const Eigen::MatrixXd y = orthonormal(x, mass, 1.0e-4);
  ASSERT_EQ(y.cols(), 3);
  EXPECT_LT((y.transpose() * mass * y - Eigen::MatrixXd::Identity(3, 3)).norm(),
            roundoff(100, 1.0));
  const Eigen::MatrixXd beyond = x - y * (y.transpose() * mass * x);
  EXPECT_LT(beyond.norm(), roundoff(100, x.norm()));
}

}  // namespace
}  // namespace abut::solve_lowest_modes_tests
