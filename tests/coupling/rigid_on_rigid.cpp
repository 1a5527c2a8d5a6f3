// Goal: rigid bodies meet rigid bodies and rigid tools, which no accurate contact takes: passively,
// and to the end. Oracles: momentum of free pairs, energy that does not grow, no overlap at the
// end.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::rigid_on_rigid_tests {
namespace {

/// Of the largest momentum of a body: impulses act on both alike.
constexpr double momentum_kept = 1.0e-12;
/// [1/s] Of the largest angular momentum, per step: while they press, points slide on each other by
/// a step times some .5 m/s, over arms of .2 m.
constexpr double angular_lost = 2.5;
/// Of the largest energy: rounding, since the midpoint rule of rigid bodies gains nothing.
constexpr double grown = 1.0e-9;

/// Of the energy: sums of as many terms as there are steps and rows.
constexpr double balanced = 1.0e-10;

SolidText body(const std::string& name, int dim, double density, std::vector<double> position,
               std::vector<double> velocity, bool falls, double step = 0.005) {
  std::vector<double> down(index(dim), 0.0);
  down.back() = -9.81;
  std::vector<std::string> weight;
  for (const double a : down) weight.push_back("\"" + number(a) + "\"");
  return {.name = name,
          .material = fmt::format("linear_elastic: {{youngs_modulus: 2.0e5, poissons_ratio: 0.3, "
                                  "density: {}}}",
                                  number(density)),
          .integrator = fmt::format("rigid_motion: {{step: {}}}", step),
          .position = std::move(position),
          .velocity = std::move(velocity),
          .port = "skin",
          .side = "boundary",
          .model = "rigid",
          .more = falls ? fmt::format("    loads: {{weight: {{acceleration: [{}]}}}}\n",
                                      fmt::join(weight, ", "))
                        : "",
          .block = block_in(dim, {0.4, 0.3, 0.3}, {2, 2, 2})};
}

std::vector<double> upwards(int dim, std::vector<double> aside, double up) {
  aside.resize(index(dim));
  aside.back() = up;
  return aside;
}

double total(const std::vector<double>& energies) {
  double sum = 0.0;
  for (const double energy : energies) sum += energy;
  return sum;
}

void expect_kept(int dim, double density, double friction, double step) {
  SCOPED_TRACE(fmt::format("{}D, density {}, friction {}, step {}", dim, density, friction, step));
  const auto result =
      run_solids(1.0, 0.01,
                 {body("one", dim, 1000.0, upwards(dim, {0.0, 0.0}, 0.2), upwards(dim, {0, 0}, 1.0),
                       false, step),
                  body("two", dim, density, upwards(dim, {0.13, 0.11}, 0.7),
                       upwards(dim, {0.2, 0.1}, -1.0), false, step)},
                 "", fmt::format("contact: {{everything: {{friction: {}}}}}\n", friction));
  ASSERT_TRUE(result->completed()) << result->end.reason;
  EXPECT_GT(result->end.given_up.normal, 0.0);
  EXPECT_LT(result->measure("momentum.total"), momentum_kept);
  EXPECT_LT(result->measure("angular_momentum.total"), angular_lost * step);
  const double first = total(result->rows.front().total);
  for (const RunResult::Row& row : result->rows) EXPECT_LT(total(row.total), (1.0 + grown) * first);
  EXPECT_TRUE(result->end.overlaps.empty());
  const GivenUp& up = result->end.given_up;
  EXPECT_NEAR(first - total(result->rows.back().total), up.joules() + up.friction,
              balanced * first);
  EXPECT_NEAR(result->measure("contact.everything.dissipated"), up.friction, balanced * first);
  EXPECT_EQ(up.friction > 0.0, friction > 0.0);
}

/// A block that slides and stops: friction of an interface has what its motion had, in passive
/// windows too. Where it was found by the body alone, nothing was told of it.
TEST(RigidOnRigid, TellsWhatFrictionTook) {
  for (const int dim : {2, 3}) {
    SCOPED_TRACE(dim);
    std::vector<double> along(index(dim), 0.0);
    along[0] = 1.0;
    const auto result = run_solids(
        0.6, 0.01,
        {body("block", dim, 1000.0, upwards(dim, {0.0, 0.0}, 0.0005), along, true),
         tool("floor", block_in(dim, {4.0, dim == 2 ? 0.2 : 4.0, 0.2}, {4, 4, 1}),
              upwards(dim, {-2.0, -2.0}, -0.2), dim == 2 ? "top" : "front")},
        "  under: {sides: [block.skin, floor.face], contact: {friction: 0.3}}\n");
    ASSERT_TRUE(result->completed()) << result->end.reason;
    const GivenUp& up = result->end.given_up;
    EXPECT_GT(up.windows, 0);
    const double motion = 0.5 * result->masses[0],
                 heat = result->measure("contact.under.dissipated");
    EXPECT_NEAR(heat, up.friction, balanced * motion);
    // It stops after 0.34 s. The fall over half a millimetre and the rocking that follows are lost
    // in normal contact: some hundredths of its motion.
    EXPECT_NEAR(heat, motion, 0.05 * motion);
  }
}

TEST(RigidOnRigid, KeepsMomentumAndGainsNothing) {
  for (const int dim : {2, 3})
    for (const double density : {1000.0, 100.0, 1.0e5})
      for (const double friction : {0.0, 0.3})
        for (const double step : {0.005, 0.00125}) expect_kept(dim, density, friction, step);
}

TEST(RigidOnRigid, RestsOnATool) {
  for (const int dim : {2, 3}) {
    SCOPED_TRACE(dim);
    const SolidText floor =
        tool("floor", block_in(dim, {4.0, dim == 2 ? 0.2 : 4.0, 0.2}, {4, 4, 1}),
             upwards(dim, {-2.0, -2.0}, -0.2), dim == 2 ? "top" : "front");
    const auto result = run_solids(
        2.0, 0.01,
        {body("one", dim, 1000.0, upwards(dim, {0.0, 0.0}, 0.1), upwards(dim, {0, 0}, 0.0), true),
         body("two", dim, 1000.0, upwards(dim, {0.03, 0.02}, 0.6), upwards(dim, {0, 0}, 0.0), true),
         floor},
        "", "contact: {everything: {friction: 0.3}}\n");
    ASSERT_TRUE(result->completed()) << result->end.reason;
    EXPECT_TRUE(result->end.overlaps.empty());
    // At rest, one on the other. What parts surfaces that are too near may spend a tenth of what
    // their contact has lost, and keeps them rocking.
    const double weight = 9.81 * result->masses[0];  // which falls by a tenth of a metre
    for (const std::string name : {"one", "two"})
      EXPECT_LT(result->measure("body." + name + ".energy.kinetic"), 0.1 * weight * 0.1) << name;
  }
}

}  // namespace
}  // namespace abut::rigid_on_rigid_tests
