// Goal: friction of rows that stick makes no energy in passive windows, however far bodies' answers
// are from linear. Oracle: the second law; what friction takes is never less than nothing.

#include <string>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut {
namespace {

/// A slab of metal comes between two rolls that turn, and yields as they draw it in.
TEST(PassiveRolling, TakesEnergyByFriction) {
  const SolidText slab{
      .name = "slab",
      .mesh = "rectangle: {lengths: [0.06, 0.01], elements: [24, 4], element: quad4, "
              "origin: centre}",
      .material = "j2_plasticity: {youngs_modulus: 7.0e10, poissons_ratio: 0.33, density: 2700.0, "
                  "yield_stress: 1.0e8, hardening: 1.0e8}",
      .integrator = "generalized_alpha: {step: 1.0e-4, spectral_radius: 0.0}",
      .position = {-0.0385, 0.0},
      .velocity = {0.225, 0.0},
      .port = "skin",
      .side = "boundary",
      .keys = "formulation: mean_dilatation, "};
  const auto roll = [](const std::string& name, double height, const std::string& angle) {
    return SolidText{.name = name,
                     .mesh = "disk: {radius: 0.05, core: 24, layers: 2, element: quad4}",
                     .position = {0.0, height},
                     .port = "skin",
                     .side = "boundary",
                     .model = "rigid_tool",
                     .keys = "turn: {angle: \"" + angle + "\"}, "};
  };
  const auto run =
      run_scene(1.8e-3, 1.0e-4,
                slab.text() + roll("top", 0.0543, "5 * t").text() +
                    roll("bottom", -0.0543, "-5 * t").text(),
                "contact: {everything: {friction: 0.5}}\n");
  ASSERT_TRUE(run->completed());
  EXPECT_GT(run->end.given_up.windows, 5) << "not passive";
  EXPECT_GE(run->end.given_up.friction, 0.0);
}

}  // namespace
}  // namespace abut
