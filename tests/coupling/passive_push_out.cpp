// Goal: what parts surfaces that begin a little in each other is paid out of what contact has lost
// for good, however much of its blows contact gives back; what supports drive into a tool ends the
// run with what it is. Oracles: energy does not grow; nothing that is held gives way.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut {
namespace {

/// Of the largest energy: Newton's tolerance in some hundred steps. Where what was given back was
/// paid to push out as well, it grew by 1e-2.
constexpr double of_newton = 1.0e-6;

/// A strip of one cell across, turned.
SolidText leaning_card(const std::string& name, double degrees, double x, double y) {
  const double c = std::cos(degrees * M_PI / 180.0), s = std::sin(degrees * M_PI / 180.0);
  return {.name = name,
          .material = "neo_hookean: {youngs_modulus: 3.0e9, poissons_ratio: 0.3, density: 800.0}",
          .integrator = "newmark: {step: 5.0e-4}",
          .position = {x, y},
          .port = "skin",
          .side = "boundary",
          .keys = fmt::format("map: [\"{0} * x - {1} * y\", \"{1} * x + {0} * y\"], ", c, s),
          .more = "    body_force: [0.0, -9.81]\n",
          .block = block_in(2, {0.09, 0.001}, {12, 1})};
}

SolidText table() {
  return {.name = "table",
          .position = {-0.2, -0.02},
          .port = "skin",
          .side = "boundary",
          .model = "rigid_tool",
          .block = block_in(2, {0.4, 0.02}, {1, 1})};
}

/// Two cards that lean towards each other; a corner of the right one begins 4.2e-5 m in the table.
TEST(PassivePushOut, IsPaidOutOfWhatIsLostForGood) {
  const auto run = run_solids(0.03, 5.0e-4,
                              {leaning_card("left", 70.0, -0.0316, 0.0006),
                               leaning_card("right", 110.0, 0.0325, 0.0003),
                               table()},
                              "", "contact: {everything: {friction: 0.5}}\n");
  ASSERT_TRUE(run->completed()) << run->end.reason;
  const GivenUp& up = run->end.given_up;
  EXPECT_GT(up.push_out, 0.0);
  EXPECT_LE(up.push_out, up.normal);
  double most = 0.0, grown = 0.0;
  for (const RunResult::Row& row : run->rows) {
    double energy = 0.0, work = 0.0;
    for (std::size_t b = 0; b < row.total.size(); ++b) energy += row.total[b], work += row.work[b];
    most = std::max(most, energy);
    grown = std::max(grown, energy - work);
  }
  EXPECT_LT(grown, of_newton * most);
}

TEST(PassivePushOut, WhatSupportsDriveOntoAToolIsNamed) {
  const auto run = run_solids(
      0.04, 1.0e-3,
      {{.name = "driven",
        .material = "neo_hookean: {youngs_modulus: 1.0e7, poissons_ratio: 0.3, density: 1000.0}",
        .integrator = "newmark: {step: 1.0e-3}",
        .position = {0.0, 0.001},
        .port = "skin",
        .side = "boundary",
        .more = "    constraints: {all: {on: boundary, x: \"0\", y: \"-0.1 * t\"}}\n",
        .block = block_in(2, {0.1, 0.1}, {1, 1})},
       table()},
      "", "contact: {everything: {}}\n");
  EXPECT_FALSE(run->completed());
  EXPECT_NE(run->end.reason.find("supports and tools drive 'driven' and 'table' onto each other"),
            std::string::npos)
      << run->end.reason;
}

}  // namespace
}  // namespace abut
