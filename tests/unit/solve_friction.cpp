// Goal: forces of rows with Coulomb's friction solve their problem: in the plane, in space, beside
// rows without friction, for every coefficient, soft and stiff couplings, rows that say the same.
// Oracles: the conditions themselves, the problem without friction, one block in closed form.

#include "subdomain_solver/solve/friction_forces.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "subdomain_solver/solve/friction_row.hpp"
#include "subdomain_solver/solve/unilateral_forces.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solve_friction_tests {
namespace {

struct Problem {
  Eigen::MatrixXd a;
  Vector b;
  std::vector<FrictionRow> rows;
};

/// Rows on a line that give way by what decays with their distance, as a surface does, components
/// mixed a little, as a slanted one's are; gaps and slips drawn.
Problem drawn(int count, int parts, double friction, double range, std::mt19937& engine) {
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  const Eigen::Index n = static_cast<Eigen::Index>(count) * parts;
  Problem p;
  Eigen::MatrixXd mix(parts, parts);
  for (Eigen::Index i = 0; i < mix.size(); ++i) mix(i) = 0.15 * draw(engine);
  mix += Eigen::MatrixXd::Identity(parts, parts);
  const Eigen::MatrixXd block = mix * mix.transpose();
  p.a.resize(n, n);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j)
      p.a.block(i * parts, j * parts, parts, parts) =
          std::exp(-std::abs(static_cast<double>(i - j)) / range) * block;
  p.b.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) p.b(i) = draw(engine) - (i % parts == 0 ? 0.4 : 0.0);
  for (int i = 0; i < count; ++i) p.rows.push_back({i * parts, parts, friction});
  return p;
}

/// Each condition for itself. `tolerance`: of the largest force, and of what it moves.
void expect_coulomb(const Problem& p, const Vector& z, double tolerance) {
  const Vector w = p.b + p.a * z;
  const double force = z.lpNorm<Eigen::Infinity>();
  const double least = tolerance * force, small = tolerance * force * p.a.diagonal().maxCoeff();
  for (const FrictionRow& row : p.rows) {
    const Eigen::Index tangents = row.parts - 1;
    const double normal = z(row.first), gap = w(row.first);
    const Vector tau = z.segment(row.first + 1, tangents);
    const Vector slip = w.segment(row.first + 1, tangents);
    EXPECT_GE(normal, 0.0);
    EXPECT_GE(gap, -small);
    EXPECT_LE(std::min(normal, gap / small * least), least);
    if (tangents == 0) continue;
    const double most = row.friction * normal;
    EXPECT_LE(tau.norm(), most * (1.0 + roundoff(8, 1.0)));
    if (tau.norm() < most - least) {
      EXPECT_LE(slip.norm(), small);
    } else if (slip.norm() > small) {  // opposed, and on the cone
      EXPECT_LE((tau * slip.norm() + most * slip).norm(),
                4.0 * (least * slip.norm() + most * small));
    }
  }
}

TEST(FrictionForces, SolveTheirProblem) {
  std::mt19937 engine(11);
  for (const int parts : {1, 2, 3})
    for (const double friction : {0.0, 0.1, 0.3, 1.0, 3.0, 10.0, 100.0, 1000.0})
      for (const double range : {0.3, 2.0, 20.0})
        for (const int count : {1, 2, 7, 40}) {
          SCOPED_TRACE(std::to_string(parts) + " parts, friction " + std::to_string(friction) +
                       ", range " + std::to_string(range) + ", rows " + std::to_string(count));
          const Problem p = drawn(count, parts, friction, range, engine);
          Vector z;
          FrictionBuffers buffers;
          ASSERT_TRUE(friction_forces(p.a, p.b, p.rows, z, buffers));
          expect_coulomb(p, z, 1.0e-10);  // a row by a row; cond A is some 1e2
          Vector again = z;
          ASSERT_TRUE(friction_forces(p.a, p.b, p.rows, again, buffers));
          EXPECT_LE((again - z).norm(), 1.0e-9 * z.norm());  // a good guess is kept
        }
}

TEST(FrictionForces, WithoutFrictionAreTheUnilateralOnes) {
  std::mt19937 engine(5);
  const Problem p = drawn(30, 1, 0.0, 2.0, engine);
  Vector z, f;
  FrictionBuffers buffers;
  UnilateralBuffers others;
  ASSERT_TRUE(friction_forces(p.a, p.b, p.rows, z, buffers));
  ASSERT_TRUE(unilateral_forces(p.a, p.b, f, others));
  EXPECT_LE((z - f).norm(), 1.0e-10 * f.norm());  // a row by a row; cond A is some 1e2
}

TEST(FrictionForces, OfMixedRowsSolveTheirProblemToo) {
  std::mt19937 engine(8);
  Problem p = drawn(24, 3, 0.3, 2.0, engine);
  p.rows.clear();
  for (int i = 0; i < 12; ++i) p.rows.push_back({6 * i, 3, 0.1 * i});
  for (int i = 0; i < 12; ++i)
    for (int k = 3; k < 6; ++k) p.rows.push_back({6 * i + k, 1, 0.0});
  Vector z;
  FrictionBuffers buffers;
  ASSERT_TRUE(friction_forces(p.a, p.b, p.rows, z, buffers));
  expect_coulomb(p, z, 1.0e-10);
}

/// A block of unit compliance pressed by 1 and pulled by `pull` along the plane.
TEST(FrictionForces, OfOneBlockAreThoseOfTheBook) {
  for (const int parts : {2, 3})
    for (const double pull : {0.1, 0.299, 0.301, 2.0}) {
      Problem p;
      p.a = Eigen::MatrixXd::Identity(parts, parts);
      p.b = Vector::Zero(parts);
      p.b(0) = -1.0;
      if (parts == 2) {
        p.b(1) = pull;
      } else {
        p.b.tail(2) << 0.6 * pull, 0.8 * pull;
      }
      p.rows = {{0, parts, 0.3}};
      Vector z;
      FrictionBuffers buffers;
      ASSERT_TRUE(friction_forces(p.a, p.b, p.rows, z, buffers));
      EXPECT_NEAR(z(0), 1.0, roundoff(8, 1.0));
      const double expected = std::min(pull, 0.3);
      EXPECT_NEAR(z.tail(parts - 1).norm(), expected, roundoff(16, 1.0));
      EXPECT_NEAR(z.tail(parts - 1).dot(p.b.tail(parts - 1)), -expected * pull, roundoff(16, 2.0));
      EXPECT_EQ(row_state(p.rows[0], z), pull < 0.3 ? RowState::sticks : RowState::slips);
    }
}

TEST(FrictionForces, OfRowsThatSayTheSameAreFound) {
  std::mt19937 engine(9);
  const Problem one = drawn(6, 3, 0.3, 1.0, engine);
  Problem twice;
  const Eigen::Index n = one.b.size();
  twice.a.resize(2 * n, 2 * n);
  twice.a << one.a, one.a, one.a, one.a;
  twice.b.resize(2 * n);
  twice.b << one.b, one.b;
  twice.rows = one.rows;
  for (FrictionRow row : one.rows) twice.rows.push_back({row.first + n, row.parts, row.friction});
  Vector z, alone;
  FrictionBuffers buffers;
  ASSERT_TRUE(friction_forces(one.a, one.b, one.rows, alone, buffers));
  ASSERT_TRUE(friction_forces(twice.a, twice.b, twice.rows, z, buffers));
  EXPECT_LE((z.head(n) + z.tail(n) - alone).norm(), 1.0e-7 * alone.norm());  // softness 1e-11 of A
}

/// Before a support a row's tangents cannot all move, whichever tangents it has.
TEST(FrictionForces, OfRowsBeforeASupportAreFound) {
  for (const double angle : {0.0, 0.3, 0.25 * M_PI, 1.5}) {
    Problem p;
    p.a = Eigen::MatrixXd::Zero(3, 3);
    const Eigen::Vector2d free(std::cos(angle), std::sin(angle));
    p.a(0, 0) = 1.0;
    p.a.bottomRightCorner(2, 2) = free * free.transpose();
    p.b = Vector::Zero(3);
    p.b(0) = -1.0;
    p.b.tail(2) = 0.2 * free;
    p.rows = {{0, 3, 0.3}};
    soften_held(p.rows, p.a);
    Vector z;
    FrictionBuffers buffers;
    ASSERT_TRUE(friction_forces(p.a, p.b, p.rows, z, buffers));
    EXPECT_NEAR((z.tail(2) + 0.2 * free).norm(), 0.0, 1.0e-7);  // rounding over the softness
  }
}

/// Rows of a sole of a block that moves as a whole by 1 and deforms by `stiff`, each for 1 N.
Problem light(int count, int dim, double stiff, double friction, std::mt19937& engine) {
  std::uniform_real_distribution<double> draw(-0.5, 0.5);
  std::normal_distribution<double> noise;
  const Eigen::Index n = static_cast<Eigen::Index>(count) * dim, whole = dim == 2 ? 3 : 6;
  Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(n, whole), places(count, 2);
  for (Eigen::Index i = 0; i < count; ++i) {
    constexpr double height = -0.25;
    const double x = draw(engine), y = dim == 2 ? 0.0 : draw(engine);
    places.row(i) << x, y;
    if (dim == 2)
      motion.block(2 * i, 0, 2, 3) << 1.0, 0.0, x, 0.0, 1.0, -height;
    else
      motion.block(3 * i, 0, 3, 6) << 1.0, 0.0, 0.0, y, -x, 0.0, 0.0, 1.0, 0.0, 0.0, height, -y,
          0.0, 0.0, 1.0, -height, 0.0, x;
  }
  Vector turns = Vector::Constant(whole, 12.0);
  turns.head(dim).setOnes();
  Problem p;
  p.a = motion * turns.asDiagonal() * motion.transpose();
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j)
      p.a.block(i * dim, j * dim, dim, dim).diagonal().array() +=
          stiff * std::exp(-4.0 * (places.row(i) - places.row(j)).norm());
  Vector fall(whole);
  for (Eigen::Index k = 0; k < whole; ++k) fall(k) = 0.3 * noise(engine) - (k == 0 ? 1.0 : 0.0);
  p.b = motion * fall;
  for (Eigen::Index k = 0; k < n; ++k) p.b(k) += 0.3 * stiff * noise(engine);
  for (int i = 0; i < count; ++i) p.rows.push_back({i * dim, dim, friction});
  return p;
}

/// A light block that is stiff: rows that hold each other, and stick or slip by ten millionths of
/// what all move together. One in ten of these has sent Newton's method round in circles.
TEST(FrictionForces, OfBodiesLighterThanTheyAreStiffAreFound) {
  std::mt19937 engine(5);
  for (const int dim : {2, 3})
    for (const double stiff : {1.0e-1, 1.0e-3, 1.0e-5, 1.0e-7})
      for (const double friction : {0.3, 1.0})
        for (int draw = 0; draw < 30; ++draw) {
          SCOPED_TRACE(fmt::format("{}D, {}, {}, {}", dim, stiff, friction, draw));
          const Problem p = light(4 + draw % 5, dim, stiff, friction, engine);
          Vector z;
          FrictionBuffers buffers;
          ASSERT_TRUE(friction_forces(p.a, p.b, p.rows, z, buffers));
          // Accurate to 1e-11 by the function's own promise; dependent rows leave 1e-8.
          EXPECT_LE(friction_residual(p.a, p.b, p.rows, z), 1.0e-8);
        }
}

/// Facets of a line whose nodes give way together, as a thin sheet's do, before a wall of more
/// points than it has nodes: rows of a facet say the same, but for the rounding of their gaps.
Problem sheet(int facets, int rows_of_facet, double friction, std::mt19937& engine) {
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  const Eigen::Index nodes = facets + 1, count = static_cast<Eigen::Index>(facets) * rows_of_facet;
  Eigen::MatrixXd bent(2 * nodes, 2 * nodes);
  for (Eigen::Index i = 0; i < nodes; ++i)
    for (Eigen::Index j = 0; j < nodes; ++j) {
      const double far = static_cast<double>(std::abs(i - j));
      const double same = far == 0.0 ? 1.0 : 0.0;
      bent.block(2 * i, 2 * j, 2, 2) << 0.05 * same + std::exp(-far / 6.0) * std::cos(far / 9.0),
          0.02 * same, 0.02 * same, 0.05 * same + 0.1 * std::exp(-far / 6.0);
    }
  Eigen::MatrixXd along = Eigen::MatrixXd::Zero(2 * count, 2 * nodes);
  Problem p;
  for (Eigen::Index r = 0; r < count; ++r) {
    const Eigen::Index facet = r / rows_of_facet;
    const double part = (static_cast<double>(r % rows_of_facet) + 0.3) / rows_of_facet;
    for (const Eigen::Index k : {0, 1}) {
      along(2 * r + k, 2 * facet + k) = 1.0 - part;
      along(2 * r + k, 2 * facet + 2 + k) = part;
    }
    p.rows.push_back({2 * r, 2, friction});
  }
  Vector free(2 * nodes);
  for (Eigen::Index k = 0; k < free.size(); ++k) free(k) = k % 2 == 0 ? -1.0 : 0.05 * draw(engine);
  p.a = along * bent * along.transpose();
  p.b = along * free;
  for (Eigen::Index k = 0; k < p.b.size(); ++k) p.b(k) += 1.0e-11 * draw(engine);
  return p;
}

/// Newton's method alone, by way of softness and rows one after the other took several hundred
/// solutions, and 4000 sweeps.
TEST(FrictionForces, OfRowsThatSayTheSameTakeFewSolutions) {
  std::mt19937 engine(3);
  for (const double friction : {0.1, 0.3, 1.0})
    for (const int rows_of_facet : {3, 5}) {
      SCOPED_TRACE(fmt::format("{}, {}", friction, rows_of_facet));
      const Problem p = sheet(20, rows_of_facet, friction, engine);
      Vector z;
      FrictionBuffers buffers;
      ASSERT_TRUE(friction_forces(p.a, p.b, p.rows, z, buffers));
      EXPECT_LE(friction_residual(p.a, p.b, p.rows, z), 1.0e-8);  // what the function promises them
      EXPECT_LE(buffers.solutions, 40u);
    }
}

template <int Tangents>
void expect_same_bits(std::mt19937& engine) {
  constexpr int parts = Tangents + 1;
  std::uniform_real_distribution<double> drawn_rate(-1.0, 0.2);
  for (int draw = 0; draw < 100; ++draw) {
    const Problem p = drawn(1, parts, 0.3 * (1 + draw % 3), 1.0, engine);
    Vector slip(Tangents), z = Vector::Zero(parts);
    for (double& value : slip) value = drawn_rate(engine);
    z(0) = draw % 2;
    const double gap = drawn_rate(engine);
    Eigen::Matrix<double, parts, 1> fixed = z;
    const Eigen::Matrix<double, parts, parts> block = p.a;
    OneRow<>(p.a, p.rows[0]).solve(gap, slip, z);
    OneRow<Tangents>(block, p.rows[0]).solve(gap, slip, fixed);
    EXPECT_EQ(Vector(fixed), z) << draw;
  }
}

TEST(FrictionForces, OfOneRowHaveTheSameBitsHoweverItsSizeIsTold) {
  std::mt19937 engine(17);
  expect_same_bits<1>(engine);
  expect_same_bits<2>(engine);
}

TEST(FrictionForces, OfWhatIsNoNumberAreNone) {
  Vector z;
  FrictionBuffers buffers;
  const Vector b = Vector::Constant(2, std::numeric_limits<double>::quiet_NaN());
  const std::vector<FrictionRow> rows = {{0, 2, 0.3}};
  EXPECT_FALSE(friction_forces(Eigen::MatrixXd::Identity(2, 2), b, rows, z, buffers));
}

}  // namespace
}  // namespace abut::solve_friction_tests
