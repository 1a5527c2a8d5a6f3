// Goal: what rests on each other passively, and gives way by much less than the distance at which
// surfaces count as touching, bears its weight and stays. Oracles: no friction and no loss where
// nothing moves; weight over two feet.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut {
namespace {

/// Of the largest energy: what contact may give or take while nothing moves. Sweeps that ended at a
/// share of the thickness gave 0.1, and their friction 0.19; measured 3e-3 and 0.015.
constexpr double of_rest = 0.02;

constexpr int voussoirs = 9;
constexpr double inner = 1.8, depth = 0.4, density = 2450.0, weight_of_mass = 9.81;  // SI

/// Number `k` from the right foot of a half ring.
SolidText voussoir(int k, const std::string& law) {
  const double turn = M_PI / voussoirs;
  const std::string angle = fmt::format("({:.17g} - {:.17g} * x)", (k + 1) * turn, turn);
  return {.name = "v" + std::to_string(k),
          .material = fmt::format(
              "{}: {{youngs_modulus: 3.3e10, poissons_ratio: 0.2, density: {}}}", law, density),
          .integrator = "hht_alpha: {step: 1.0e-3}",
          .keys = fmt::format("map: [\"({0} + y) * cos({1})\", \"({0} + y) * sin({1})\"], ", inner,
                              angle),
          .sides = {"left", "right"},
          .more = fmt::format("    body_force: [0.0, -{}]\n", weight_of_mass),
          .block = block_in(2, {1.0, depth}, {3, 2})};
}

/// Its weight shortens the arch by microns, a hundredth of the thickness of surfaces.
ResultPtr arch(const std::string& law) {
  std::vector<SolidText> bodies;
  std::string joints;
  const auto meet = [&joints](const std::string& one, const std::string& other) {
    joints += fmt::format("  j{}: {{sides: [{}, {}], contact: {{friction: 0.6}}}}\n",
                          joints.size(), one, other);
  };
  for (int k = 0; k < voussoirs; ++k) bodies.push_back(voussoir(k, law));
  for (int k = 0; k + 1 < voussoirs; ++k)
    meet(fmt::format("v{}.left", k), fmt::format("v{}.right", k + 1));
  meet("ground.top", "v0.right");
  meet("ground.top", fmt::format("v{}.left", voussoirs - 1));
  bodies.push_back({.name = "ground",
                    .position = {-3.0, -1.0},
                    .port = "top",
                    .side = "top",
                    .model = "rigid_tool",
                    .block = block_in(2, {6.0, 1.0}, {1, 1})});
  return run_solids(0.4, 1.0e-3, bodies, joints);
}

TEST(PassiveRests, AnArchOfStiffBlocksStaysWhereItIs) {
  const ResultPtr run = arch("linear_elastic");
  ASSERT_TRUE(run->completed()) << run->end.reason;
  const GivenUp& up = run->end.given_up;
  ASSERT_GT(up.windows, 100);
  EXPECT_LT(up.friction, of_rest * up.largest);
  EXPECT_LT(std::abs(up.joules()), of_rest * up.largest);
}

// Loads set in on blocks that rest. The first windows make energy there that is not judged, as
// bodies have none yet; the passive way, which makes none, takes it back, and does not end the run.
TEST(PassiveRests, WhatAccurateWindowsMadeAtTheStartEndsNoRun) {
  const ResultPtr run = arch("saint_venant_kirchhoff");
  ASSERT_TRUE(run->completed()) << run->end.reason;
  ASSERT_GT(run->end.given_up.windows, 100);
  EXPECT_GT(run->end.given_up.repaid, 0.0);
}

}  // namespace
}  // namespace abut
