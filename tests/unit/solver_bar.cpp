// Goal: the discretised bar keeps the mass, knows its stable step, and its solver solves.
// Oracles: total mass, growth of the highest mode on either side of the limit, a dense solver.

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "subdomain_solver/fe/bar.hpp"
#include "subdomain_solver/solve/tridiagonal.hpp"
#include "subdomain_solver/time/central_difference.hpp"
#include "tests/support/tolerance.hpp"

namespace abut {
namespace {

BarProperties properties(int elements) {
  BarProperties bar;
  bar.length = 0.7;
  bar.area = 2.0;
  bar.elements = elements;
  bar.youngs_modulus = 5.0;
  bar.density = 3.0;
  return bar;
}

TEST(Bar, EveryLayerAndMassFormKeepsTheTotalMass) {
  using enum ContactLayer;
  for (int elements = 1; elements <= 5; ++elements) {
    for (MassForm mass : {MassForm::lumped, MassForm::averaged, MassForm::consistent}) {
      for (ContactLayer left : {none, massless, kick, massive}) {
        for (ContactLayer right : {none, massless, kick, massive}) {
          if (elements == 1 && left == massless && right == massless) continue;  // refused
          BarProperties data = properties(elements);
          data.mass = mass;
          data.layer = {left, right};
          const Bar bar(data);
          double rows = 0.0, matrix = 0.0;
          for (double m : bar.row_mass()) rows += m;
          for (double m : bar.mass()) matrix += m;
          for (double m : bar.mass_beside()) matrix += 2.0 * m;
          // a few roundings per element
          EXPECT_NEAR(rows, data.mass_total(), roundoff(8 * elements, data.mass_total()));
          EXPECT_NEAR(matrix, data.mass_total(), roundoff(8 * elements, data.mass_total()));
        }
      }
    }
  }
}

TEST(Bar, AMasslessEndHasNoMassAndItsNeighbourHasTheWholeElement) {
  BarProperties data = properties(4);
  data.layer = {ContactLayer::massless, ContactLayer::kick};
  const Bar bar(data);
  EXPECT_EQ(bar.inverse_mass().front(), 0.0);
  EXPECT_EQ(bar.row_mass().front(), 0.0);
  EXPECT_NEAR(bar.row_mass()[1], 1.5 * bar.element_mass(), roundoff(4, bar.element_mass()));
  EXPECT_NEAR(bar.row_mass()[4], 0.5 * bar.element_mass(), roundoff(4, bar.element_mass()));
}

TEST(Bar, AFixedEndDoesNotMove) {
  BarProperties data = properties(3);
  data.fixed = {true, false};
  const Bar bar(data);
  EXPECT_EQ(bar.inverse_mass().front(), 0.0);
  EXPECT_GT(bar.inverse_mass().back(), 0.0);
}

TEST(Bar, StableStepOfAUniformBarIsCellOverWaveSpeed) {
  for (int elements : {1, 2, 3, 10, 200}) {
    const Bar bar(properties(elements));
    const double cell = bar.spacing() / bar.data().wave_speed();
    EXPECT_NEAR(bar.stable_step(), cell, roundoff(16, cell)) << elements;
  }
}

/// Largest size of a displacement after a zigzag start, relative to it, in 500 steps of a share of
/// the limit.
double growth(double share) {
  const Bar bar(properties(10));
  const double dt = share * bar.stable_step();
  CentralDifference scheme(bar, dt, 1);
  BarState state;
  state.v.assign(11, 0.0);
  state.a.assign(11, 0.0);
  for (int i = 0; i < 11; ++i) state.u.push_back(i % 2 == 0 ? 1.0 : -1.0);
  scheme.open(state, dt, {});
  double most = 0.0;
  for (int i = 0; i < 500; ++i) {
    scheme.substep(state, dt, {});
    most = std::fmax(most, largest_size(state.u));
  }
  return most;
}

TEST(Bar, AStepAboveTheLimitGrowsAndOneBelowStaysBounded) {
  // Zigzag amplitude of the undamped recurrence at dt = s x limit is 1 / sqrt(1 - s^2) = 7.1 at
  // s = 0.99 (from rest it does not exceed that); at 1.01 it grows by acosh(2 1.01^2 - 1) = 0.283
  // per step, exp(141) in 500 steps.
  EXPECT_LT(growth(0.99), 7.1);
  EXPECT_GT(growth(1.01), 1.0e50);
}

TEST(TriDiagonal, SolvesAsADenseSolverDoes) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int n : {1, 2, 3, 10, 100}) {
    std::vector<double> diagonal, beside, right;
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i) {
      diagonal.push_back(2.5 + any(random));  // above the sum of its neighbours: positive definite
      right.push_back(any(random));
      dense(i, i) = diagonal.back();
      if (i + 1 < n) {
        beside.push_back(0.7 * any(random));
        dense(i, i + 1) = dense(i + 1, i) = beside.back();
      }
    }
    const Eigen::VectorXd b = Eigen::Map<Eigen::VectorXd>(right.data(), n);
    const Eigen::VectorXd expected = dense.partialPivLu().solve(b);
    TriDiagonal matrix;
    EXPECT_FALSE(matrix.factored());
    matrix.factor(diagonal, beside);
    EXPECT_TRUE(matrix.factored());
    matrix.solve(right);
    for (int i = 0; i < n; ++i) {
      // condition below 20, a few roundings per row; sizes of about 1
      EXPECT_NEAR(right[static_cast<std::size_t>(i)], expected[i], roundoff(20 * 8, 1.0));
    }
  }
}

TEST(EndReaction, IsTheForceThatKeepsTheEndAtItsTarget) {
  EndAction action;
  action.kind = EndAction::Kind::obstacle;
  action.target = 0.5;
  EXPECT_EQ(end_reaction(0.75, 0.5, action), 0.5);
  EXPECT_EQ(end_reaction(0.25, 0.5, action), 0.0);  // no pull without a bilateral obstacle
  action.bilateral = true;
  EXPECT_EQ(end_reaction(0.25, 0.5, action), -0.5);
}

}  // namespace
}  // namespace abut
