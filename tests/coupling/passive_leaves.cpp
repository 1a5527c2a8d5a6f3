// Goal: statics that go passively find the equilibrium of slender bodies too, which bend under a
// thousandth of what holds them while impulses are found. Oracle: leaves that lie on each other
// without friction share the load, F L^3 / (3 n E I) (S. Timoshenko, Strength of Materials).

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut {
namespace {

/// Shear, a root that holds the section's height, steps of forces on nodes of unlike meshes: 1.9 %
/// on these. What the mass alone let go of was 2 % of the deflection.
constexpr double of_beams = 0.03;

TEST(PassiveLeaves, BendTogether) {
  constexpr double length = 0.2, height = 0.004, width = 0.02, modulus = 2.0e11, force = 3.0;
  const auto leaf = [&](int number, int cells) {
    return SolidText{
        .name = fmt::format("leaf{}", number),
        .material = fmt::format(
            "linear_elastic: {{youngs_modulus: {}, poissons_ratio: 0.3, density: 7800.0}}",
            modulus),
        .integrator = "quasi_static: {step: 0.5}",
        .position = {0.0, -number * height},
        .port = "skin",
        .side = "boundary",
        .keys = fmt::format("plane: stress, thickness: {}, ", width),
        .more = "    constraints: {root: {on: left, fixed: true}}\n" +
                (number > 0 ? std::string()
                            : fmt::format("    loads: {{tip: {{on: right, traction: [\"0\", "
                                          "\"-{} * t\"]}}}}\n",
                                          force / (height * width))),
        .block = block_in(2, {length, height}, {cells, 1}, "quad9")};
  };
  const auto run = run_solids(1.0, 0.5, {leaf(0, 16), leaf(1, 16), leaf(2, 24)}, "",
                              "contact: {everything: {}}\nschwarz: {max_iterations: 1}\n");
  ASSERT_TRUE(run->completed()) << run->end.reason;
  EXPECT_GT(run->end.given_up.windows, 0);
  const double inertia = width * std::pow(height, 3) / 12.0;
  const double bent = force * std::pow(length, 3) / (3.0 * 3.0 * modulus * inertia);
  EXPECT_NEAR(run->measure("body.leaf0.displacement.y.min"), -bent, of_beams * bent);
}

}  // namespace
}  // namespace abut
