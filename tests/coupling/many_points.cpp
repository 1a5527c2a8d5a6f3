// Goal: contact of more points than one matrix and one kernel are made of, row by row and with a
// kernel of near points, is the same contact. Oracle: bars without lateral strain that meet with
// whole faces, of meshes that do not match, pass a constant pressure as it is: nothing moves
// sideways, whatever rubs, and motions along the bars are those of a few cells across.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::many_points_tests {
namespace {

/// Bars of 0.2 m, four cells deep, ten windows after they touched at 20 m/s.
ResultPtr bars(int left, int right, const std::vector<std::string>& more) {
  std::vector<std::string> overrides = {
      "meta.expect=[]",
      "output={}",
      "time={begin: 0.0, end: 4.0e-5, window: 4.0e-6}",
      "bodies.left.integrator={central_difference: {step: 4.0e-6}}",
      "bodies.right.integrator={central_difference: {step: 4.0e-6}}",
      "bodies.left.initial.position=[-0.2, 0.0, 0.0]",
      "bodies.right.initial.position=[1.0e-6, 0.0, 0.0]"};
  for (const auto& [body, across] : {std::pair{"left", left}, {"right", right}})
    overrides.push_back(fmt::format(
        "bodies.{0}.model.fe.mesh={{box: {{lengths: [0.2, 0.2, 0.2], elements: [4, {1}, {1}]}}}}",
        body, across));
  overrides.insert(overrides.end(), more.begin(), more.end());
  return run_file(ABUT_SOURCE_DIR "/configs/contact/bars_3d.yaml", overrides);
}

/// Of the way that the body has gone: what gaps of 1e-12 of it leave of a pressure, ten times.
constexpr double sideways = 1.0e-10;
/// As the scene itself asks: momentum point by point, and the energy of cells this coarse.
constexpr double momentum_left = 1.0e-11, energy_left = 1.0e-3;

void expect_straight(const RunResult& run, const RunResult& few) {
  ASSERT_TRUE(run.completed());
  EXPECT_GT(run.measure("contact.impact.closings"), 0.0);
  EXPECT_LE(run.measure("schwarz.iterations_max"), 3.0);  // bands leave a thousandth to sweeps
  EXPECT_LE(run.measure("momentum.total"), momentum_left);
  EXPECT_LE(std::abs(run.measure("energy.total.relative_drift_end")), energy_left);
  for (const std::string body : {"left", "right"}) {
    const std::string at = "body." + body + ".displacement.";
    const double way = std::abs(few.measure(at + "x.mean"));
    for (const std::string along : {"y", "z"})
      EXPECT_LE(std::max(run.measure(at + along + ".max"), -run.measure(at + along + ".min")),
                sideways * way)
          << body;
    // The sweeps' tolerance, 1e-6 of what the bodies go in a window, in each of ten.
    EXPECT_NEAR(run.measure(at + "x.mean"), few.measure(at + "x.mean"), 1.0e-6 * way) << body;
  }
}

TEST(ManyPoints, PressureIsThatOfFew) {
  const auto few = bars(4, 5, {});
  ASSERT_TRUE(few->completed());
  const auto many = bars(26, 27, {});
  expect_straight(*many, *few);
}

TEST(ManyPoints, RubbedPressureIsThatOfFew) {
  const auto few = bars(4, 5, {});
  ASSERT_TRUE(few->completed());
  const auto many = bars(26, 27, {"interfaces.impact.contact={friction: 0.3}"});
  expect_straight(*many, *few);
}

}  // namespace
}  // namespace abut::many_points_tests
