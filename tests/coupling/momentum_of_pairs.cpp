// Goal: momentum is exact for every pair of schemes, joined or in contact, whatever their steps
// [M.24]. Oracle: forces are equal and opposite, and each body takes its whole impulse.

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::momentum_of_pairs_tests {
namespace {

constexpr double speed = 0.01;  // of that of sound
/// Of all momenta: 500 steps of 80 nodes, forces of sum and difference of as many roundings, and
/// places that are 10 times as far as waves strain.
constexpr double rounding = 1.0e-12;

struct Steps {
  double one, other, window;  // [s]
};

std::vector<std::string> schemes(double step) {
  std::vector<std::string> all;
  for (const char* scheme : {"central_difference: {{step: {0}}}", "newmark: {{step: {0}}}",
                             "hht_alpha: {{step: {0}}}", "hht_alpha: {{step: {0}, alpha: -0.3}}",
                             "generalized_alpha: {{step: {0}, spectral_radius: 0.0}}",
                             "generalized_alpha: {{step: {0}, spectral_radius: 0.5}}",
                             "generalized_alpha: {{step: {0}, spectral_radius: 0.9}}"})
    all.push_back(fmt::format(fmt::runtime(scheme), number(step)));
  return all;
}

/// A bar in one dimension, or one of 6 cells along and `across` over it.
std::string body(const std::string& name, int dim, int across, const std::string& scheme,
                 const std::string& start, const std::string& ports) {
  const std::string mesh = dim == 1   ? "bar: {length: 1.0, elements: 6, area: 0.25}"
                           : dim == 2 ? block_mesh({1.0, 0.25}, {6, across})
                                      : block_mesh({1.0, 0.25, 0.25}, {6, across, across});
  SolidText out{.name = name,
                .dim = dim,
                .mesh = mesh,
                .material = law_in(dim, unit_law("linear_elastic", 0.3)),
                .integrator = scheme,
                .start = start};
  out.more = "    ports: {" + ports + "}\n";
  return out.text();
}

ResultPtr run(int dim, bool tied, const Steps& steps, const std::string& one,
              const std::string& other, double end) {
  const std::string tie = tied && dim == 1 ? ", tied: true" : "";
  const auto start = [dim](double place, double v) {
    return fmt::format("position: {}, velocity: {}", components({place}, dim),
                       components({v}, dim));
  };
  // How unlike steps and a plastic start treat energy has tests of its own.
  return run_scene(
      end, steps.window,
      body("a", dim, 2, one, start(-1.0, speed), "face: {side: right" + tie + "}") +
          body("b", dim, 3, other, start(tied ? 0.0 : 0.002, 0.0), "face: {side: left" + tie + "}"),
      fmt::format("interfaces: {{i: {{sides: [a.face, b.face], {}: {{}}}}}}\n"
                  "schwarz: {{energy_guard: 10.0}}\n",
                  tied ? "tied" : "contact"));
}

/// The one is tied to the other, which the third one hits.
auto hit(const std::string& one, const std::string& other, const std::string& third,
         const std::string& side = "right") {
  std::string text = body("a", 2, 2, one, "position: [0.0, 0.0]", "face: {side: right}");
  text += body("b", 2, 2, other, "position: [1.0, 0.0]",
               "face: {side: left}, end: {side: " + side + "}");
  text += body("c", 2, 3, third, "position: [2.001, 0.0], velocity: [-0.01, 0.0]",
               "face: {side: left}");
  return run_scene(3.0, 0.05, text,
                   "interfaces:\n" + joined("joint", "a.face", "b.face") +
                       touching("hit", "b.end", "c.face") + "schwarz: {energy_guard: 10.0}\n");
}

struct Kind {
  int dim;
  bool tied;
};

class MomentumOfPairs : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Joints, MomentumOfPairs,
                         testing::Values(Kind{1, true}, Kind{1, false}, Kind{2, true},
                                         Kind{2, false}, Kind{3, true}, Kind{3, false}),
                         [](const auto& c) {
                           return fmt::format("{}d_{}", c.param.dim,
                                              c.param.tied ? "tied" : "contact");
                         });

TEST_P(MomentumOfPairs, IsExactForAllSchemesAndSteps) {
  const auto& [dim, tied] = GetParam();
  for (const Steps& steps :
       {Steps{0.0125, 0.0125, 0.025}, {0.0125, 0.05, 0.05}, {0.015, 0.035, 0.105}}) {
    for (const std::string& one : schemes(steps.one)) {
      for (const std::string& other : schemes(steps.other)) {
        if (steps.one == steps.other && one > other) continue;  // seen from the other side
        SCOPED_TRACE(one + " and " + other);
        const double end = std::round(3.0 / steps.window) * steps.window;
        const auto result = run(dim, tied, steps, one, other, end);
        ASSERT_TRUE(result->completed());
        EXPECT_GT(result->velocity(1), 0.1 * speed) << "nothing has passed";
        EXPECT_LE(result->measure("momentum.total"), rounding);
      }
    }
  }
}

/// A body that is tied on one side and hit on the other.
TEST(MomentumOfPairs, IsExactWhereAJointAndAContactMeet) {
  const Steps steps{0.0125, 0.025, 0.05};
  for (const std::string& one : schemes(steps.one)) {
    for (const std::string& other : schemes(steps.other)) {
      SCOPED_TRACE(one + " and " + other);
      const auto result = hit(one, other, one);
      ASSERT_TRUE(result->completed());
      EXPECT_LE(result->measure("momentum.total"), rounding);
    }
  }
}

/// A run may end within a window, and its last step be shorter than the others: a scheme that tells
/// momentum with what it holds back holds back less in it.
TEST_P(MomentumOfPairs, IsExactWhereTheLastStepIsShorter) {
  const auto& [dim, tied] = GetParam();
  const Steps steps{0.0125, 0.0125, 0.025};
  for (const std::string& one : schemes(steps.one)) {
    for (const std::string& other : schemes(steps.other)) {
      if (one > other) continue;
      SCOPED_TRACE(one + " and " + other);
      for (const double part : {0.1, 0.7}) {  // of a window, in the midst of contact
        const auto result = run(dim, tied, steps, one, other, 1.0 + part * steps.window);
        ASSERT_TRUE(result->completed());
        EXPECT_GT(result->velocity(1), 0.1 * speed) << "nothing has passed";
        EXPECT_LE(result->measure("momentum.total"), rounding);
      }
    }
  }
}

/// Two bodies of one scheme and step keep accelerations that know nothing of the tie; what hits one
/// of them in finer steps presses with means, which jump between windows. Where all of its outside
/// may touch, the nodes at the rim of the tie have no mass.
TEST(MomentumOfPairs, IsExactWhereOneOfTwoAlikeIsHit) {
  const Steps steps{0.025, 0.0125, 0.05};
  for (const std::string& alike : schemes(steps.one)) {
    for (const std::string& other : schemes(steps.other)) {
      for (const std::string side : {"right", "boundary"}) {
        SCOPED_TRACE(alike + " and " + other + ", " + side);
        const auto result = hit(alike, alike, other, side);
        ASSERT_TRUE(result->completed());
        // Twice: slopes of the last two means make rims without mass move once more [M.164].
        EXPECT_LE(result->measure("momentum.total"), 2.0 * rounding);
      }
    }
  }
}

}  // namespace
}  // namespace abut::momentum_of_pairs_tests
