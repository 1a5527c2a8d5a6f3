// Goal: rigid bodies meet rigid bodies and rigid tools, which no accurate contact takes: passively,
// and to the end. Oracles: momentum of free pairs, energy that does not grow, no overlap at the
// end.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut {
namespace {

/// Of the largest momentum of a body: impulses act on both alike.
constexpr double momentum_kept = 1.0e-12;
/// Of the largest angular momentum. Lever arms are those of a step's begin, and bodies turn by the
/// midpoint of their step: of second order, 5e-3 s at some rad/s.
constexpr double angular_kept = 2.0e-3;
/// Of the largest energy: rounding, since the midpoint rule of rigid bodies gains nothing.
constexpr double grown = 1.0e-9;

SolidText body(const std::string& name, int dim, double density, std::vector<double> position,
               std::vector<double> velocity, bool falls) {
  std::vector<double> down(index(dim), 0.0);
  down.back() = -9.81;
  std::vector<std::string> weight;
  for (const double a : down) weight.push_back("\"" + number(a) + "\"");
  return {.name = name,
          .material = fmt::format("linear_elastic: {{youngs_modulus: 2.0e5, poissons_ratio: 0.3, "
                                  "density: {}}}",
                                  number(density)),
          .integrator = "rigid_motion: {step: 0.005}",
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

TEST(RigidOnRigid, KeepsMomentumAndGainsNothing) {
  for (const int dim : {2, 3}) {
    for (const double density : {1000.0, 100.0, 1.0e5}) {
      for (const double friction : {0.0, 0.3}) {
        SCOPED_TRACE(fmt::format("{}D, density {}, friction {}", dim, density, friction));
        const auto result =
            run_solids(1.0, 0.01,
                       {body("one", dim, 1000.0, upwards(dim, {0.0, 0.0}, 0.2),
                             upwards(dim, {0, 0}, 1.0), false),
                        body("two", dim, density, upwards(dim, {0.13, 0.11}, 0.7),
                             upwards(dim, {0.2, 0.1}, -1.0), false)},
                       "", fmt::format("contact: {{everything: {{friction: {}}}}}\n", friction));
        ASSERT_TRUE(result->completed()) << result->end.reason;
        EXPECT_GT(result->end.given_up.normal, 0.0);
        EXPECT_LT(result->measure("momentum.total"), momentum_kept);
        EXPECT_LT(result->measure("angular_momentum.total"), angular_kept);
        const double first = total(result->rows.front().total);
        for (const RunResult::Row& row : result->rows)
          EXPECT_LT(total(row.total), (1.0 + grown) * first);
        EXPECT_TRUE(result->end.overlaps.empty());
      }
    }
  }
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
    // at rest, one on the other: what is left is nothing beside a fall over a body's height
    const double weight = 9.81 * result->masses[0];
    for (const std::string name : {"one", "two"})
      EXPECT_LT(result->measure("body." + name + ".energy.kinetic"), 1.0e-3 * weight * 0.3) << name;
  }
}

}  // namespace
}  // namespace abut
