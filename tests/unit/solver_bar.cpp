// Goal: the discretised bar keeps the mass, knows its stable step, and its solver solves.
// Oracles: total mass, growth of the highest mode on either side of the limit, a dense solver.

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "subdomain_solver/bars/bar.hpp"
#include "subdomain_solver/bars/central_difference.hpp"
#include "subdomain_solver/solve/tridiagonal.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solver_bar_tests {
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
double growth(double share, double tchamwa = 1.0) {
  BarProperties data = properties(10);
  data.tchamwa = tchamwa;
  const Bar bar(data);
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

TEST(Tchamwa, LowersTheStableStepAsTheoryTells) {
  // phi = 1.2, z = s^2 4 / (2 phi - 1). At s = 0.99 the outer root is -0.83: the recurrence from 1,
  // 1 (no acceleration at the start), 1 - phi z = -2.36, 2.77 decays from there on. At s = 1.02 it
  // is -1.24, and 1.24^500 = 1e46.
  EXPECT_LT(growth(0.99, 1.2), 2.78);
  EXPECT_GT(growth(1.02, 1.2), 1.0e40);
}

TEST(Tchamwa, OneMassOnASpringFollowsItsRecurrence) {
  // Tchamwa and Wielgosz: u(n+1) - (2 - phi z) u(n) + (1 - (phi - 1) z) u(n-1) = 0, z = (omega
  // dt)^2, so that the energy falls by the factor 1 - (phi - 1) z in a step.
  BarProperties data = properties(1);
  data.fixed = {true, false};
  data.tchamwa = 1.1;
  const Bar bar(data);
  const double dt = 0.6 * bar.stable_step();
  const double z = dt * dt * bar.element_stiffness() * bar.inverse_mass().back();
  for (const int window : {1, 7}) {  // steps between open and close
    CentralDifference scheme(bar, dt, 1);
    BarState state;
    state.u = {0.0, 1.0};
    state.v = {0.0, 0.3};
    state.a = {0.0, -bar.element_stiffness() * bar.inverse_mass().back()};
    std::vector<double> u{state.u.back()};
    for (int i = 0; i < 70; ++i) {
      if (i % window == 0) scheme.open(state, dt, {});
      scheme.substep(state, dt, {});
      u.push_back(state.u.back());
      if (i % window == window - 1) scheme.close(state, dt);
    }
    for (std::size_t n = 1; n + 1 < u.size(); ++n) {
      const double rest = u[n + 1] - (2.0 - 1.1 * z) * u[n] + (1.0 - 0.1 * z) * u[n - 1];
      EXPECT_NEAR(rest, 0.0, roundoff(20, 1.0)) << "window " << window << ", step " << n;
    }
  }
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
      EXPECT_NEAR(right[i], expected[i], roundoff(20 * 8, 1.0));
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
}  // namespace abut::solver_bar_tests
