// Rows of contact that are solved for one after the other, near rows alone in the matrix. Oracles:
// the dense matrix  sum over sides of B C B^T,  and the forces of the dense solvers.

#include "subdomain_solver/solve/near_rows.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "contract/kernel.hpp"
#include "contract/point_rings.hpp"
#include "subdomain_solver/solve/unilateral_forces.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::near_rows_tests {
namespace {

/// Of the largest force: rounds end at 1e-14 of it, and the dense solvers, whose matrix has a
/// condition of some tens, at as much.
constexpr double rounds_left = 100.0 * 1.0e-14;

/// A square of points, joined to quadrilaterals, whose compliance falls by `fall` a point.
struct Square {
  int side;
  PortKernel kernel;
  Eigen::MatrixXd full;  // (values, values)

  Square(int points, int rings, double fall, std::mt19937& random) : side(points) {
    std::vector<std::int32_t> facets, offsets(1, 0);
    for (int y = 0; y + 1 < side; ++y)
      for (int x = 0; x + 1 < side; ++x) {
        const int p = y * side + x;
        facets.insert(facets.end(), {p, p + 1, p + side + 1, p + side});
        offsets.push_back(static_cast<std::int32_t>(facets.size()));
      }
    PointRings around(side * side, facets, offsets);
    std::uniform_real_distribution<double> some(-0.2, 0.2);
    kernel.patterns = kernel.width = 3 * side * side;
    kernel.band.dim = 3;
    kernel.band.offsets.assign(1, 0);
    full.setZero(kernel.width, kernel.width);
    for (std::int32_t p = 0; p < side * side; ++p) {
      for (const std::int32_t q : around.around(p, rings)) {
        kernel.band.reached.push_back(q);
        const int far = std::max(std::abs(p % side - q % side), std::abs(p / side - q / side));
        for (int j = 0; j < 3; ++j)
          for (int i = 0; i < 3; ++i) {
            double& value = full(3 * q + i, 3 * p + j);
            if (q < p) value = full(3 * p + j, 3 * q + i);
            if (q == p && i < j) value = full(3 * p + j, 3 * p + i);
            if (q > p || (q == p && i >= j))
              value = std::pow(fall, far) * (i == j ? 1.0 : 0.5 * some(random));
            kernel.displacement.push_back(value);
          }
      }
      kernel.band.offsets.push_back(static_cast<std::int32_t>(kernel.band.reached.size()));
    }
  }
};

/// Rows of every point of the first square on one or two points of the second, in random
/// directions.
struct Problem {
  std::vector<PressedSide> sides;
  std::vector<FrictionRow> rows;
  Eigen::MatrixXd matrix;
  Vector gaps;

  Problem(const Square& k, const Square& n, double friction, std::mt19937& random) {
    std::uniform_real_distribution<double> some(-1.0, 1.0);
    const int parts = friction > 0.0 ? 3 : 1, count = k.side * k.side;
    std::vector<Eigen::MatrixXd> terms;
    for (const Square* square : {&k, &n}) {
      PressedSide& side = sides.emplace_back();
      side.near = &square->kernel;
      side.moved = square->kernel.displacement;
      side.points = index(square->side * square->side);
      side.begins.assign(1, 0);
      terms.emplace_back(Eigen::MatrixXd::Zero(count * parts, square->kernel.width));
    }
    for (int r = 0; r < count; ++r) {
      rows.push_back({r * parts, parts, friction});
      Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
      const Eigen::Vector3d lean(1.0, 0.2 * some(random), 0.2 * some(random));
      axes.col(0) = lean.normalized();
      axes.col(1) = axes.col(0).unitOrthogonal();
      axes.col(2) = axes.col(0).cross(axes.col(1));
      const int other = std::min(r, n.side * n.side - 1), beside = std::max(0, other - 1);
      const double part = 0.25 + 0.25 * some(random);
      for (int p = 0; p < parts; ++p) {
        for (int d = 0; d < 3; ++d) {
          sides[0].terms.push_back({3 * r + d, axes(d, p)});
          sides[1].terms.push_back({3 * other + d, (1.0 - part) * axes(d, p)});
          if (beside != other) sides[1].terms.push_back({3 * beside + d, part * axes(d, p)});
        }
        for (PressedSide& side : sides) side.begins.push_back(side.terms.size());
      }
    }
    matrix.setZero(count * parts, count * parts);
    for (std::size_t s = 0; s < 2; ++s) {
      for (std::size_t c = 0; c < sides[s].components(); ++c)
        for (const PressedSide::Term& term : sides[s].of(c))
          terms[s](static_cast<Eigen::Index>(c), term.value) += term.factor;
      matrix += terms[s] * (s == 0 ? k : n).full * terms[s].transpose();
    }
    gaps.resize(count * parts);
    for (double& gap : gaps) gap = some(random);
  }

  /// By rounds, as contact does: what near rows leave out is in the rates of the next round.
  Vector solve() const {
    const NearBlocks near = near_rows(rows, sides);
    Vector force = Vector::Zero(gaps.size());
    for (int round = 0; round < 100; ++round) {
      Vector rates = gaps + matrix * force;
      double first = 0.0;
      for (int pass = 0; pass < 5; ++pass) {
        const double change = relax(near, rows, rates, force);
        if (pass == 0) first = change;
      }
      if (first <= 1.0e-14 * force.lpNorm<Eigen::Infinity>()) break;
    }
    return force;
  }
};

// Goal: near blocks are those of the dense matrix but for what is small: motions below 2 % of the
// pressed point's own, of two sides, and blocks below 1 %, make less than 5 % of a row's own block.
// Rounds end because of it, and forces do not depend on it.
TEST(NearRows, BlocksAreThoseOfTheDenseMatrix) {
  std::mt19937 random(11);
  for (const double friction : {0.0, 0.3}) {
    const Square k(7, 2, 0.15, random), n(6, 3, 0.2, random);
    const Problem problem(k, n, friction, random);
    const NearBlocks near = near_rows(problem.rows, problem.sides);
    Eigen::MatrixXd left = problem.matrix;
    for (std::size_t r = 0; r < problem.rows.size(); ++r) {
      const FrictionRow& row = problem.rows[r];
      EXPECT_EQ(index(near.opened[near.own[r]]), r);
      for (std::size_t e = near.offsets[r]; e < near.offsets[r + 1]; ++e) {
        const FrictionRow& to = problem.rows[index(near.opened[e])];
        left.block(to.first, row.first, to.parts, row.parts) -= Eigen::Map<const Eigen::MatrixXd>(
            near.blocks.data() + near.begins[e], to.parts, row.parts);
      }
      const double own = problem.matrix.block(row.first, row.first, row.parts, row.parts)
                             .lpNorm<Eigen::Infinity>();
      EXPECT_LE(left.middleCols(row.first, row.parts).cwiseAbs().maxCoeff(), 0.05 * own);
    }
  }
}

// Goal: near rows along turned tangents are those that are made for these, and forces turn with
// them: what they press on points stays. Oracle: near_rows, PressedSide::press; a turn is two
// products with directions of length 1, so that rounding is all that parts them.
TEST(NearRows, TurnWithTheirTangents) {
  std::mt19937 random(5);
  const Square k(6, 2, 0.15, random), n(5, 2, 0.2, random);
  Problem problem(k, n, 0.3, random);
  std::vector<double> before, now;
  std::uniform_real_distribution<double> angle(-3.0, 3.0);
  NearBlocks near = near_rows(problem.rows, problem.sides);
  PressedSide& own = problem.sides.front();
  for (std::size_t r = 0; r < problem.rows.size(); ++r) {
    const double a = angle(random), cosine = std::cos(a), sine = std::sin(a);
    for (std::size_t p = 0; p < 3; ++p)
      for (const PressedSide::Term& term : own.of(3 * r + p)) before.push_back(term.factor);
    for (PressedSide& side : problem.sides) {
      const std::size_t first = side.begins[3 * r + 1], second = side.begins[3 * r + 2];
      for (std::size_t t = 0; t < second - first; ++t) {
        double &one = side.terms[first + t].factor, &other = side.terms[second + t].factor;
        const double turned = cosine * one + sine * other;
        other = cosine * other - sine * one;
        one = turned;
      }
    }
    for (std::size_t p = 0; p < 3; ++p)
      for (const PressedSide::Term& term : own.of(3 * r + p)) now.push_back(term.factor);
  }
  const Vector pressed = Vector::LinSpaced(problem.gaps.size(), 1.0, 2.0);
  Vector force = pressed;
  turn(near, problem.rows, 3, before, now, force);
  std::vector<double> on(3 * problem.sides.front().points), then(on.size());
  PressedSide was = problem.sides.front();
  for (std::size_t t = 0; t < was.terms.size(); ++t) was.terms[t].factor = before[t];
  was.press(pressed, on);
  problem.sides.front().press(force, then);
  for (std::size_t v = 0; v < on.size(); ++v) EXPECT_NEAR(on[v], then[v], roundoff(2.0, 27.0));
  const NearBlocks made = near_rows(problem.rows, problem.sides);
  for (std::size_t r = 0; r < problem.rows.size(); ++r) {
    const double* one = near.blocks.data() + near.begins[near.own[r]];
    const double* other = made.blocks.data() + made.begins[made.own[r]];
    for (int e = 0; e < 9; ++e) EXPECT_NEAR(one[e], other[e], roundoff(other[0], 27.0));
  }
}

// Goal: without friction, forces are those of the primal-dual active set. They are unique, as the
// matrix is definite; 1e-12 is a hundred times what either leaves of the largest.
TEST(NearRows, ForcesAreThoseOfActiveSets) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    const Square k(9, 2, 0.15, random), n(8, 2, 0.2, random);
    const Problem problem(k, n, 0.0, random);
    Vector dense;
    UnilateralBuffers buffers;
    ASSERT_TRUE(unilateral_forces(problem.matrix, problem.gaps, dense, buffers));
    const Vector force = problem.solve();
    EXPECT_GT((force.array() > 0.0).count(), 10);
    EXPECT_GT((force.array() == 0.0).count(), 10);
    EXPECT_LE((force - dense).lpNorm<Eigen::Infinity>(),
              rounds_left * dense.lpNorm<Eigen::Infinity>())
        << "seed " << seed;
  }
}

// Goal: with friction, forces fit Coulomb's law by the dense matrix as well as the dense solver's
// do, and are its forces.
TEST(NearRows, ForcesThatRubAreThoseOfTheDenseSolver) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    const Square k(6, 2, 0.15, random), n(5, 2, 0.2, random);
    const Problem problem(k, n, 0.3, random);
    Vector dense;
    FrictionBuffers buffers;
    ASSERT_TRUE(friction_forces(problem.matrix, problem.gaps, problem.rows, dense, buffers));
    const Vector force = problem.solve();
    EXPECT_LE(friction_residual(problem.matrix, problem.gaps, problem.rows, force), rounds_left);
    EXPECT_LE((force - dense).lpNorm<Eigen::Infinity>(),
              10.0 * rounds_left * dense.lpNorm<Eigen::Infinity>())
        << "seed " << seed;
  }
}

/// Of rounds that leave a tenth none is lost, of rounds that would take three hundred most are.
TEST(NearRows, RoundsThatWouldNotEndAreTold) {
  const auto rounds_until_told = [](double factor) {
    std::vector<double> changes;
    for (int round = 0; round < 100; ++round) {
      changes.push_back(std::pow(factor, round));
      if (too_slow(changes)) return round + 1;
    }
    return 0;
  };
  EXPECT_EQ(rounds_until_told(0.1), 0);
  EXPECT_EQ(rounds_until_told(0.9), 0);
  EXPECT_EQ(rounds_until_told(0.95), 9);
  EXPECT_EQ(rounds_until_told(1.01), 9);
}

}  // namespace
}  // namespace abut::near_rows_tests
