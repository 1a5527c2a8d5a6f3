// Goal: friction knows no length, no force and no time: a block on an inclined plane, one that
// sticks and one that slides, is the same at any scale.
// Oracle: the same scene with all lengths, forces and accelerations multiplied by a power of two,
// which rounds nothing: every number of the run is that of the first one, multiplied.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::friction_scaling_tests {
namespace {

struct Speeds {
  double stays = 0.0, slides = 0.0;  // [m/s] in lengths of a block
};

/// Densities and times stay, so that moduli go with the square of the length.
Speeds on_a_plane(double scale, const std::string& scheme) {
  const auto block = [&](const std::string& name, double place) {
    return SolidText{
        .name = name,
        .dim = 2,
        .mesh = block_mesh({scale, 0.5 * scale}, {6, 3}),
        .material = fmt::format(
            "linear_elastic: {{youngs_modulus: {}, poissons_ratio: 0.3, density: 1000.0}}",
            number(1.0e9 * scale * scale)),
        .integrator = scheme,
        .position = {place * scale, 0.0},
        .side = "bottom",
        .more =
            fmt::format("    loads: {{gravity: {{acceleration: [\"{} * min(1, 50 * t)\", \"{} * "
                        "min(1, 50 * t)\"]}}}}\n",
                        number(2.8 * scale), number(-9.4 * scale))};
  };
  const SolidText plane = {.name = "plane",
                           .dim = 2,
                           .mesh = block_mesh({6.0 * scale, scale}, {2, 1}),
                           .position = {-scale, -scale},
                           .side = "top",
                           .model = "rigid_tool"};
  const auto result = run_solids(
      0.1, 2.0e-3, {block("stays", 0.0), block("slides", 2.0), plane},
      "  holds: {sides: [stays.face, plane.face], contact: {friction: 0.32}}\n"
      "  yields: {sides: [slides.face, plane.face], contact: {friction: 0.2, static_friction: "
      "0.25}}\n");
  EXPECT_TRUE(result->completed());
  return {result->velocity(0) / scale, result->velocity(1) / scale};
}

TEST(FrictionScaling, OfAllLengthsAndForcesChangesNothing) {
  for (const std::string scheme :
       {"generalized_alpha: {spectral_radius: 0.0, step: 2.0e-3}", "newmark: {step: 2.0e-4}",
        "central_difference: {step: 4.0e-5}"}) {
    const Speeds one = on_a_plane(1.0, scheme);
    // a (t - 0.01 s), and what a block sways by
    EXPECT_NEAR(one.slides, (2.8 - 0.2 * 9.4) * 0.09, 0.02 * one.slides) << scheme;
    // What sticks creeps by what the block sways.
    EXPECT_LT(std::abs(one.stays), 0.01 * one.slides) << scheme;
    for (const double scale : {8.0, 0.125, 1.0 / 1024.0}) {
      const Speeds other = on_a_plane(scale, scheme);
      EXPECT_EQ(other.slides, one.slides) << scheme << " at " << scale;
      EXPECT_EQ(other.stays, one.stays) << scheme << " at " << scale;
    }
  }
}

}  // namespace
}  // namespace abut::friction_scaling_tests
