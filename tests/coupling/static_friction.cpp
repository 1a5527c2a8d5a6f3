// Goal: what sticks has a coefficient of its own and sweeps end all the same: it holds for a whole
// substep, so that forces follow continuously from where the bodies are.
// Oracles: closed form of a block that is pulled until it slides; friction takes energy and makes
// none; the sweeps that one coefficient takes.

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::static_friction_tests {
namespace {

struct Friction {
  double slides, sticks;
  std::string text() const {
    return fmt::format("contact: {{friction: {}, static_friction: {}}}", slides, sticks);
  }
};

/// A plate that is pulled along its sole by 8 (t - 0.2 s) of its mass, under a weight of 10 N/kg,
/// stays until that is the coefficient of what sticks, then the other one resists.
TEST(StaticFriction, HoldsUntilItIsOvercomeAndThenLetsGo) {
  for (const auto& [scheme, step] : std::vector<std::pair<std::string, double>>{
           {"newmark: {step: 0.001}", 1.0e-3},
           {"generalized_alpha: {step: 0.001, spectral_radius: 0.5}", 1.0e-3}}) {
    for (const Friction& friction : {Friction{0.2, 0.4}, {0.1, 0.5}, {0.3, 0.4}, {0.39, 0.4}}) {
      for (const int steps : {1, 5}) {
        SCOPED_TRACE(fmt::format("{} {} {}", scheme, friction.text(), steps));
        const SolidText block{
            .name = "block",
            .material =
                "linear_elastic: {youngs_modulus: 1.0e7, poissons_ratio: 0.0, density: 1000.0}",
            .integrator = scheme,
            .port = "sole",
            .side = "bottom",
            .more =
                "    loads:\n"
                "      weight: {acceleration: [\"0\", \"-10 * min(1, 5 * t)\"]}\n"
                "      pull: {on: bottom, traction: [\"400 * max(t - 0.2, 0)\", \"0\"]}\n",
            .block = {{1.0, 0.05}, {8, 1}}};
        const SolidText plane = tool("plane", {{12.0, 0.2}, {4, 1}}, {-1.0, -0.2}, "top");
        const auto result = run_solids(
            1.0, step * steps, {block, plane},
            fmt::format("  rubs: {{sides: [block.sole, plane.face], {}}}\n", friction.text()));
        ASSERT_TRUE(result->completed());
        const double at = 0.2 + friction.sticks * 10.0 / 8.0, rest = 1.0 - at;
        const double pulled = 4.0 * (0.8 * 0.8 - (at - 0.2) * (at - 0.2));
        const double v = pulled - 10.0 * friction.slides * rest;
        // In the step in which it begins to slide the plate feels what holds it: one step at most,
        // and in one more where it goes passively then.
        const double drop = 10.0 * (friction.sticks - friction.slides) * step;
        EXPECT_NEAR(result->measure("mean_velocity.block.end_x"), v,
                    (result->end.given_up.windows > 0 ? 2.1 : 1.1) * drop);
        // Equations are solved to 1e-9 of the forces.
        EXPECT_LE(result->measure("energy.total.relative_drift_end"), 1.0e-9);
        EXPECT_EQ(result->measure("schwarz.iterations_max"), 1.0);
      }
    }
  }
}

/// Disks of rubber that meet beside their centres; they stick and slide in parts.
ResultPtr disks(const Friction& friction, int steps) {
  const auto disk = [](const std::string& name, int core, const std::vector<double>& place,
                       double speed) {
    return SolidText{
        .name = name,
        .mesh = fmt::format("disk: {{radius: 0.5, core: {}, layers: 3}}", core),
        .material = "neo_hookean: {youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000.0}",
        .integrator = "central_difference: {step: 6.0e-6}",
        .position = place,
        .velocity = {speed},
        .port = "rim",
        .side = "mantle"};
  };
  return run_solids(
      0.003, 6.0e-6 * steps, {disk("left", 6, {-0.51}, 50.0), disk("right", 4, {0.51, 0.3}, -50.0)},
      fmt::format("  impact: {{sides: [left.rim, right.rim], {}}}\n", friction.text()),
      "schwarz: {tolerance: 1.0e-3}\n");
}

TEST(StaticFriction, AddsNoSweepWhereItDiffersFromThatOfWhatSlides) {
  for (const int steps : {1, 5}) {
    const auto same = disks({0.2, 0.2}, steps);
    ASSERT_TRUE(same->completed());
    const double sweeps = same->measure("schwarz.iterations_mean");
    for (const Friction& friction : std::vector<Friction>{{0.2, 0.25},
                                                          {0.2, 0.22},
                                                          {0.2, 0.5},
                                                          {0.1, 0.5},
                                                          {0.4, 0.5},
                                                          {0.3, 0.6},
                                                          {0.05, 0.8},
                                                          {0.25, 0.3},
                                                          {0.15, 0.2}}) {
      SCOPED_TRACE(fmt::format("{} {}", friction.text(), steps));
      const auto result = disks(friction, steps);
      ASSERT_TRUE(result->completed());
      EXPECT_LE(result->measure("schwarz.iterations_mean"), sweeps + 0.1);
      EXPECT_LE(result->measure("schwarz.iterations_max"), 5.0);
      EXPECT_LE(result->measure("energy.total.relative_drift_end"), 0.0);
      // Facets turn by 15 degrees: 0.7 % while they pass each other, whatever rubs.
      EXPECT_LE(result->measure("energy.total.relative_drift_max"), 0.01);
    }
  }
}

}  // namespace
}  // namespace abut::static_friction_tests
