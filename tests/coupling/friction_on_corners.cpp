// Goal: what friction took is told where several rows press on one point of the finder: a corner
// of a block on the coarse facets of a floor, which other nodes of the block hang over.
// Oracle: balance of energy. Nothing but friction takes any, so what bodies lose is its heat.

#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::friction_on_corners_tests {
namespace {

struct Corner {
  std::string name;
  double stiffness = 1.0;      // of the block over that of the floor
  std::string finder, scheme;  // of both
  double step = 0.0;           // [s] of the block; the floor's is 0.005
  double friction = 0.3;       // sticks mostly where stiff, slides where soft
};

void PrintTo(const Corner& corner, std::ostream* out) { *out << corner.name; }

std::vector<Corner> corners() {
  std::vector<Corner> out;
  for (const double stiffness : {0.2, 1.0, 5.0})
    for (const std::string finder : {"floor", "block"})
      for (const std::string scheme : {"newmark", "central_difference"})
        for (const double friction : {0.1, 0.3})
          for (const bool alike : {true, false})
            out.push_back({fmt::format("{}_found_by_{}_{}_{:g}_tenths_{:g}_tenths",
                                       alike ? "alike" : "unlike", finder, scheme, 10.0 * friction,
                                       10.0 * stiffness),
                           stiffness, finder, scheme, alike ? 0.005 : 0.02 / 3.0, friction});
  return out;
}

class FrictionOnCorners : public testing::TestWithParam<Corner> {};
INSTANTIATE_TEST_SUITE_P(Combinations, FrictionOnCorners, testing::ValuesIn(corners()),
                         [](const auto& c) { return c.param.name; });

TEST_P(FrictionOnCorners, TellsJustWhatBodiesLose) {
  const Corner& corner = GetParam();
  const auto scheme = [&corner](double step) {
    return fmt::format("{}: {{step: {}}}", corner.scheme, number(step));
  };
  const std::string law =
      "linear_elastic: {{youngs_modulus: {}, poissons_ratio: 0.25, density: 1.0}}";
  const SolidText floor{.name = "floor",
                        .material = fmt::format(fmt::runtime(law), "1.0"),
                        .integrator = scheme(0.005),
                        .position = {-2.0, -0.5},
                        .side = "top",
                        .more = "    constraints: {held: {on: bottom, fixed: true}}\n",
                        .block = {{4.0, 1.0}, {4, 2}}};
  const SolidText block{.name = "block",
                        .material = fmt::format(fmt::runtime(law), number(corner.stiffness)),
                        .integrator = scheme(corner.step),
                        .position = {0.3, 1.07},
                        .velocity = {0.1, -0.1},
                        .side = "boundary",
                        .keys =
                            "map: [\"0.8 * (x - 0.4) - 0.6 * (y - 0.4)\", "
                            "\"0.6 * (x - 0.4) + 0.8 * (y - 0.4)\"], ",
                        .block = {{0.8, 0.8}, {5, 5}}};
  const auto result =
      run_solids(2.0, 0.02, {floor, block},
                 fmt::format("  touch: {{sides: [floor.face, block.face], contact: {{friction: "
                             "{:g}}}, transmission: {{unilateral: {{kinematic: {}.face}}}}}}\n",
                             corner.friction, corner.finder));
  ASSERT_TRUE(result->completed());
  EXPECT_GE(result->measure("contact.touch.closings"), 1.0);
  // As without friction: what a row that begins to press stores in half a step, in parts of the
  // block's energy. 8e-3 were told too much where rows without force counted the point's shear.
  EXPECT_LE(result->measure("energy.total.relative_drift_max"), 2.0e-4);
}

}  // namespace
}  // namespace abut::friction_on_corners_tests
