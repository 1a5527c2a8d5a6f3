// Goal: what is physics does not depend on frame, units, size of the speed, or the order in which a
// scene lists things. Oracle: the same run, transformed.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::invariance_tests {
namespace {

const RunResult& reference() {
  static const ResultPtr result = run(two_bars());
  return *result;
}

TEST(Invariance, AMovingFrameSeesTheSameContact) {
  for (double frame : {1.0e3, -1.0e5}) {
    SceneText scene = two_bars();
    for (BarText& bar : scene.bars) bar.velocity += frame;
    const ResultPtr r = run(scene);
    ASSERT_TRUE(r->completed());
    // displacements grow by frame x 1e-3 s: their round-off over the motion of a step, 1e-5 m
    const double rounding = roundoff(1000, std::abs(frame) * 1e-3 / 1e-5);
    EXPECT_NEAR(
        r->measure("contact.first.duration") / reference().measure("contact.first.duration"), 1.0,
        rounding);
    EXPECT_NEAR((r->velocity(0) - frame) / reference().velocity(0), 1.0, rounding);
    EXPECT_NEAR(
        r->measure("contact.first.force_mean") / reference().measure("contact.first.force_mean"),
        1.0, rounding);
  }
}

TEST(Invariance, UnitsDoNotMatter) {
  // metres to micrometres, kilograms to grams, seconds to milliseconds
  const double m = 1e6, kg = 1e3, s = 1e3;
  SceneText scene = two_bars();
  for (BarText& bar : scene.bars) {
    bar.length *= m;
    bar.area *= m * m;
    bar.modulus *= kg / (m * s * s);
    bar.density *= kg / (m * m * m);
    bar.position *= m;
    bar.velocity *= m / s;
    bar.integrator = explicit_scheme(1.0e-7 * s, 6);
  }
  scene.begin *= s;
  scene.end *= s;
  scene.window *= s;
  const ResultPtr r = run(scene);
  ASSERT_TRUE(r->completed());
  // round-off of 1e4 steps, of either sign
  const double rounding = roundoff(1e4, 1.0);
  EXPECT_NEAR(
      r->measure("contact.first.duration") / s / reference().measure("contact.first.duration"), 1.0,
      rounding);
  EXPECT_NEAR(r->velocity(0) * s / m / reference().velocity(0), 1.0, rounding);
  EXPECT_EQ(r->measure("schwarz.iterations_mean"), reference().measure("schwarz.iterations_mean"));
}

TEST(Invariance, TheOrderOfBodiesAndSidesDoesNotMatter) {
  SceneText swapped_bodies = two_bars();
  std::swap(swapped_bodies.bars[0], swapped_bodies.bars[1]);
  SceneText swapped_sides = two_bars();
  std::swap(swapped_sides.interfaces[0][0], swapped_sides.interfaces[0][1]);
  for (const SceneText& scene : {swapped_bodies, swapped_sides}) {
    const ResultPtr r = run(scene);
    EXPECT_NEAR(r->measure("contact.first.duration"), reference().measure("contact.first.duration"),
                5e-4 * iteration(1e-6));
    EXPECT_NEAR(std::abs(r->velocity(0)), std::abs(reference().velocity(0)), 100 * iteration(1e-6));
  }
}

TEST(Invariance, TheMirrorImageIsTheMirrorImage) {
  SceneText scene = two_bars();
  scene.bars[0].position = 0.02;
  scene.bars[0].velocity = -100.0;
  scene.bars[0].sides = {"left"};
  scene.bars[1].position = -0.27;
  scene.bars[1].velocity = 100.0;
  scene.bars[1].sides = {"right"};
  scene.interfaces = {{"left.left", "right.right"}};
  const ResultPtr r = run(scene);
  EXPECT_NEAR(r->velocity(0), -reference().velocity(0), roundoff(1e4, 100.0));
  EXPECT_NEAR(r->measure("contact.first.duration"), reference().measure("contact.first.duration"),
              roundoff(1e4, 5e-4));
}

class Speed : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Invariance, Speed, testing::Values(1e-9, 1e-6, 1e-3, 1.0, 500.0));

TEST_P(Speed, OfTheImpactIsAScaleAlone) {
  SceneText scene = two_bars();
  const double v = GetParam();
  scene.bars[0].velocity = v;
  scene.bars[1].velocity = -v;
  scene.bars[0].position = -0.25 - v * 2e-4;
  scene.bars[1].position = v * 2e-4;
  const ResultPtr r = run(scene);
  ASSERT_TRUE(r->completed());
  EXPECT_NEAR(r->velocity(0) / v, -0.998986, 1e-6);  // as at 100 m/s, its digits
  EXPECT_NEAR(r->measure("contact.first.duration"), reference().measure("contact.first.duration"),
              5e-4 * iteration(1e-6));
  EXPECT_LE(r->measure("schwarz.iterations_max"), 2.0);
  // The reference position of 0.25 m is rounded once: a shift of the impact by eps / v.
  EXPECT_NEAR(r->measure("contact.first.begin"), 0.0, 1e-12 + roundoff(4, 0.25 / v));
}

TEST(Start, TouchingBarsThatApproachImpactAtOnce) {
  SceneText scene = two_bars();
  scene.bars[0].position = -0.25;
  scene.bars[1].position = 0.0;
  const ResultPtr r = run(scene);
  ASSERT_TRUE(r->completed());
  EXPECT_NEAR(r->measure("contact.first.begin"), -2.0e-4, roundoff(4, 1e-3));
  EXPECT_NEAR(r->measure("contact.first.duration"), reference().measure("contact.first.duration"),
              5e-4 * iteration(1e-6));
  EXPECT_NEAR(r->velocity(0), reference().velocity(0), 1e-3);  // vibration goes on a little longer
}

TEST(Start, TouchingBarsAtRestStayAtRest) {
  SceneText scene = two_bars();
  scene.closed_form = false;
  scene.bars[0].position = -0.25;
  scene.bars[1].position = 0.0;
  scene.bars[0].velocity = scene.bars[1].velocity = 0.0;
  const ResultPtr r = run(scene);
  EXPECT_TRUE(r->completed());
  EXPECT_TRUE(r->events.empty());
  EXPECT_EQ(r->rows.back().u, (std::vector<double>{0.0, 0.0}));
  EXPECT_EQ(r->rows.back().total, (std::vector<double>{0.0, 0.0}));
}

TEST(Start, BarsThatPartNeverMeet) {
  SceneText scene = two_bars();
  scene.closed_form = false;
  scene.bars[0].position = -0.25;
  scene.bars[1].position = 0.0;
  scene.bars[0].velocity = -1.0;
  scene.bars[1].velocity = 1.0;
  const ResultPtr r = run(scene);
  EXPECT_TRUE(r->completed());
  EXPECT_TRUE(r->events.empty());
  EXPECT_NEAR(r->velocity(0), -1.0, roundoff(1e4, 1.0));
}

}  // namespace
}  // namespace abut::invariance_tests
