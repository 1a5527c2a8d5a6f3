// Goal: in passive steps what sticks has its own coefficient of friction, as it has in accurate
// ones. Oracles: Coulomb's law; Newton's.

#include <string>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::passive_friction_tests {
namespace {

constexpr double g = 9.81, begin = 0.1, end = 1.0;  // [m/s^2], [s]

/// A block rests on a floor and is pulled by an acceleration that grows as g (t - 0.1) to most g.
ResultPtr pulled(int dim, double most, const std::string& law) {
  const SolidText block{
      .name = "block",
      .material = "linear_elastic: {youngs_modulus: 1.0e7, poissons_ratio: 0.3, density: 1000.0}",
      .integrator = "rigid_motion: {step: 0.002}",
      .port = "foot",
      .side = dim == 2 ? "bottom" : "back",
      .model = "rigid",
      .more = fmt::format("    loads: {{pull: {{acceleration: [\"{} * max(0, min(t - {}, {}))\", "
                          "{}\"-{}\"]}}}}\n",
                          g, begin, most, dim == 2 ? "" : "\"0\", ", g),
      .block =
          dim == 2 ? block_in(2, {0.2, 0.1}, {2, 1}) : block_in(3, {0.2, 0.2, 0.1}, {2, 2, 1})};
  const SolidText floor =
      dim == 2
          ? tool("floor", block_in(2, {20.0, 1.0}, {1, 1}), {-10.0, -1.0}, "top")
          : tool("floor", block_in(3, {20.0, 20.0, 1.0}, {1, 1, 1}), {-10.0, -10.0, -1.0}, "front");
  return run_solids(end, 0.002, {block, floor},
                    "  under: {sides: [block.foot, floor.face], contact: " + law + "}\n");
}

class PassiveFriction : public testing::TestWithParam<int> {};

/// 0.5 g is more than 0.3 and less than 0.6 of the weight.
TEST_P(PassiveFriction, HoldsWhatSticks) {
  const auto run = pulled(GetParam(), 0.5, "{friction: 0.3, static_friction: 0.6}");
  ASSERT_TRUE(run->completed()) << run->end.reason;
  EXPECT_GT(run->end.given_up.windows, 0);
  // What sweeps leave.
  EXPECT_NEAR(run->measure("body.block.velocity.x.mean"), 0.0, 1.0e-6);
  EXPECT_LT(run->measure("contact.under.dissipated"), 1.0e-6);
}

/// What slides has the coefficient of sliding from the step after on: from 0.7 s, at 0.6 g.
TEST_P(PassiveFriction, IsThatOfSlidingOnceItSlides) {
  const auto run = pulled(GetParam(), 0.7, "{friction: 0.3, static_friction: 0.6}");
  ASSERT_TRUE(run->completed()) << run->end.reason;
  const double grows = 0.1 * (0.65 - 0.3), then = 0.2 * (0.7 - 0.3);  // over g, of both times
  // A few steps of 500 until it slides faster than what sweeps leave, and the pull is of a step's
  // middle: measured 1.3 % less.
  EXPECT_NEAR(run->measure("body.block.velocity.x.mean"), g * (grows + then),
              0.03 * g * (grows + then));
}

/// A plate that slides hops along: where it comes down it slides, and has the coefficient of that.
/// Of every impact friction takes 0.1 of the impulse, whatever the step.
TEST(PassiveFrictionOfHops, IsThatOfSliding) {
  for (const double step : {5.0e-4, 5.0e-5}) {
    const auto run = run_text(fmt::format(
        R"(time: {{end: 0.5, window: {0}}}
bodies:
  floor:
    model:
      rigid_tool: {{dimension: 2, mesh: {{rectangle: {{lengths: [9, 0.1], elements: [1, 1]}}}}}}
    initial: {{position: [-1, -0.1]}}
    ports: {{top: {{side: top}}}}
  plate:
    model:
      rigid:
        dimension: 2
        mesh: {{rectangle: {{lengths: [0.3, 0.02], elements: [1, 1], origin: centre}}}}
    material: {{linear_elastic: {{youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000}}}}
    integrator: {{rigid_motion: {{step: {0}}}}}
    initial: {{position: [0, 0.06], velocity: [5, 0]}}
    body_force: [0, -10]
    ports: {{skin: {{side: boundary}}}}
contact: {{everything: {{friction: 0.1, static_friction: 0.5, restitution: 0.8}}}}
)",
        number(step)));
    ASSERT_TRUE(run->completed()) << run->end.reason;
    const double mass = 1000.0 * 0.3 * 0.02, fall = 10.0 * 0.5;  // [kg], [m/s] by the end
    const double pressed = run->measure("body.plate.velocity.y.mean") + fall;
    EXPECT_GT(mass * pressed, 20.0);  // it has hopped
    // What sweeps leave.
    EXPECT_NEAR(5.0 - run->measure("body.plate.velocity.x.mean"), 0.1 * pressed, 1.0e-6) << step;
  }
}

TEST_P(PassiveFriction, HasOneCoefficientWhereTheSceneGivesOne) {
  const auto run = pulled(GetParam(), 0.5, "{friction: 0.3}");
  ASSERT_TRUE(run->completed()) << run->end.reason;
  const double grows = 0.2 * (0.4 - 0.3), then = 0.4 * (0.5 - 0.3);  // from 0.4 s
  EXPECT_NEAR(run->measure("body.block.velocity.x.mean"), g * (grows + then),
              0.03 * g * (grows + then));
}

INSTANTIATE_TEST_SUITE_P(Dimensions, PassiveFriction, testing::Values(2, 3));

}  // namespace
}  // namespace abut::passive_friction_tests
