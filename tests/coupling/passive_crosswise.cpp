// Goal: what is stacked crosswise, face on face without a gap, rests: where rims cross, no corner
// of either body is near the other one. And so does a heavy body on a light one. Oracle: weights.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::passive_crosswise_tests {
namespace {

constexpr double g = 9.81;

/// A box about its middle, turned about z.
SolidText box(const std::string& name, const std::string& model, const std::vector<double>& lengths,
              const std::vector<double>& middle, double turned, double density = 1000.0) {
  const bool stands = model == "rigid_tool";
  const double c = std::cos(turned), s = std::sin(turned);
  SolidText out{
      .name = name,
      .material = stands ? ""
                         : fmt::format("linear_elastic: {{youngs_modulus: 1.0e9, poissons_ratio: "
                                       "0.3, density: {}}}",
                                       density),
      .integrator = stands             ? ""
                    : model == "rigid" ? "rigid_motion: {step: 0.002}"
                                       : "newmark: {step: 0.002}",
      .position = middle,
      .port = "skin",
      .side = "boundary",
      .model = model,
      .keys = fmt::format("map: [\"{0} * x - {1} * y\", \"{1} * x + {0} * y\", \"z\"], ", number(c),
                          number(s)),
      .more = stands ? "" : fmt::format("    body_force: [0.0, 0.0, -{}]\n", g)};
  out.dim = 3;
  out.mesh = fmt::format("box: {{lengths: [{}, {}, {}], elements: [1, 1, 1], origin: centre}}",
                         lengths[0], lengths[1], lengths[2]);
  return out;
}

struct Crossing {
  std::string model;
  double turned;  // [rad]
  std::vector<double> aside;
};

class PassiveCrosswise : public testing::TestWithParam<Crossing> {};

/// A bar lies across another one, which stands.
TEST_P(PassiveCrosswise, Rests) {
  const Crossing& c = GetParam();
  const std::vector<double> beam{0.3, 0.05, 0.05};
  const auto run =
      run_solids(0.3, 0.002,
                 {box("low", "rigid_tool", beam, {0.0, 0.0, 0.025}, 0.0),
                  box("bar", c.model, beam, {c.aside[0], c.aside[1], 0.075}, c.turned)},
                 "", "contact: {everything: {friction: 0.4}}\n");
  ASSERT_TRUE(run->completed()) << run->end.reason;
  const double mass = 1000.0 * 0.3 * 0.05 * 0.05;
  // It begins with no force, and bounces on its stiffness by parts of a step's fall.
  EXPECT_NEAR(run->measure("contact.everything.impulse"), mass * g * 0.3, 0.01 * mass * g * 0.3);
  EXPECT_NEAR(run->measure("body.bar.velocity.z.mean"), 0.0, 0.1 * g * 0.002);
  for (const RunEvent& event : run->events)
    EXPECT_EQ(event.text.find("overlap"), std::string::npos) << event.text;
}

INSTANTIATE_TEST_SUITE_P(Bars, PassiveCrosswise,
                         testing::Values(Crossing{"rigid", 1.5707963267948966, {0.004, 0.003}},
                                         Crossing{"rigid", 1.5707963267948966, {0.0, 0.0}},
                                         Crossing{"rigid", 0.7, {0.004, -0.003}},
                                         Crossing{"rigid", 0.3, {0.0, 0.0}},
                                         Crossing{"fe", 1.5707963267948966, {0.004, 0.003}},
                                         Crossing{"fe", 0.7, {0.004, -0.003}}),
                         [](const auto& p) {
                           return fmt::format("{}_{}_{}", p.param.model, p.index,
                                              static_cast<int>(10 * p.param.turned));
                         });

class HeavyOnLight : public testing::TestWithParam<double> {};

/// Boxes of one size, aside of each other along both axes, the upper one so many times as heavy.
TEST_P(HeavyOnLight, Rests) {
  const double ratio = GetParam();
  const std::vector<double> size{0.1, 0.1, 0.05};
  const auto run = run_solids(0.5, 0.002,
                              {box("ground", "rigid_tool", {4.0, 4.0, 1.0}, {0.0, 0.0, -0.5}, 0.0),
                               box("light", "rigid", size, {0.0, 0.0, 0.025}, 0.0, 1.0),
                               box("heavy", "rigid", size, {0.004, 0.003, 0.075}, 0.0, ratio)},
                              "", "contact: {everything: {friction: 0.4}}\n");
  ASSERT_TRUE(run->completed()) << run->end.reason;
  for (const char* name : {"light", "heavy"})
    for (const char* axis : {"x", "y"})
      EXPECT_NEAR(run->measure(fmt::format("body.{}.velocity.{}.mean", name, axis)), 0.0, 0.02);
  for (const RunEvent& event : run->events)
    EXPECT_EQ(event.text.find("overlap"), std::string::npos) << event.text;
}

INSTANTIATE_TEST_SUITE_P(Ratios, HeavyOnLight, testing::Values(1.0, 100.0, 1000.0));

/// A block on two pads whose sides are flush with its own: edges of the pads pass the line between
/// two facets of its side, over which nothing leaves it. By that line they were told as 94 mm deep,
/// were pushed, and 2 % of the energy went with it.
TEST(PassiveFlush, SidesAreNoWayOut) {
  const auto run = run_text(R"(time: {end: 0.05, window: 0.001}
bodies:
  floor:
    model: {rigid_tool: {dimension: 3, mesh: {box: {lengths: [2, 2, 0.1], elements: [1, 1, 1]}}}}
    initial: {position: [-1, -1, -0.1]}
    ports: {top: {side: front}}
  pad:
    copies: {grid: {count: [2, 1, 1], spacing: [0.8, 0, 0]}}
    model: {fe: {dimension: 3, mesh: {box: {lengths: [0.1, 0.1, 0.05], elements: [2, 2, 2]}}}}
    material: {linear_elastic: {youngs_modulus: 1.0e8, poissons_ratio: 0.0, density: 10}}
    integrator: {newmark: {step: 0.001}}
    initial: {position: [-0.45, -0.05, 0]}
    ports: {skin: {side: boundary}}
  block:
    model:
      rigid:
        dimension: 3
        mesh: {box: {lengths: [1, 0.1, 0.5], elements: [1, 1, 1], origin: centre}}
    material: {linear_elastic: {youngs_modulus: 1.0e11, poissons_ratio: 0.0, density: 8000}}
    integrator: {rigid_motion: {step: 0.001}}
    initial: {position: [0, 0, 0.3]}
    body_force: [0, 0, -10]
    ports: {skin: {side: boundary}}
contact: {everything: {friction: 0}}
)");
  ASSERT_TRUE(run->completed()) << run->end.reason;
  const GivenUp& up = run->end.given_up;
  EXPECT_GT(up.windows, 0);
  const double sinks = 2.0 * 4000.0 * 0.05 / (2.0 * 1.0e8 * 0.01);  // [m] 2 m g / k
  EXPECT_LT(up.deepest, 0.1 * sinks);
  EXPECT_LT(up.joules(), 1.0e-3 * 4000.0 * sinks);  // of its weight's work
}

}  // namespace
}  // namespace abut::passive_crosswise_tests
