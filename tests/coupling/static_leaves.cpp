// Goal: leaves of a spring that are clamped at the same end and lie on each other have an answer in
// statics: between nodes that both clamps hold no force opens or closes anything, and there is
// none. Oracle: beam theory.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::static_leaves_tests {
namespace {

constexpr double length = 0.2, depth = 0.004, modulus = 2.0e11, pressed = 1.05e-3;  // SI

/// What clamps bear across the leaves, the largest of all windows and at the end.
struct Clamps : Observer {
  explicit Clamps(std::size_t count) : most(count, 0.0), end(count, 0.0) {}
  void on_window(const WindowReport& report) override {
    for (std::size_t k = 0; k < most.size(); ++k) {
      const std::vector<double>& columns = report.responses[k].records.back().columns;
      end[k] = columns[1];
      most[k] = std::max(most[k], std::hypot(columns[0], columns[1]));
    }
  }
  std::vector<double> most, end;  // [N]
};

struct Leaves {
  int count;
  double friction, step;
};

class StaticLeaves : public testing::TestWithParam<Leaves> {};

TEST_P(StaticLeaves, BearWhatBeamsBear) {
  const auto [count, friction, step] = GetParam();
  std::vector<SolidText> bodies;
  for (int k = 0; k < count; ++k)
    bodies.push_back(
        {.name = "leaf" + std::to_string(k),
         .material = fmt::format(
             "linear_elastic: {{youngs_modulus: {}, poissons_ratio: 0.0, density: 7800.0}}",
             modulus),
         .integrator = "quasi_static: {step: " + number(step) + "}",
         .position = {0.0, -depth * k},
         .port = "skin",
         .side = "boundary",
         .more = "    constraints: {root: {on: left, fixed: true}}\n",
         .block = {{length, depth}, {20, 1}, "quad8"}});
  // Its face is above the tips by a twentieth of its way.
  const SolidText press =
      tool("press", block_in(2, {0.02, 0.02}, {1, 1}), {length - 0.01, depth + 0.05 * pressed},
           "bottom", fmt::format("way: [\"0\", \"-{} * t\"], ", pressed));
  bodies.push_back(press);
  Clamps clamps(index(count));
  const auto run =
      run_text(scene_text(1.0, step, texts_of(bodies),
                          fmt::format("contact: {{everything: {{friction: {}}}}}\n", friction)),
               &clamps);
  ASSERT_TRUE(run->completed()) << run->end.reason;
  EXPECT_EQ(run->end.given_up.windows, 0);
  // The near edge of the face presses, as the tips lean away from it.
  const double bends = modulus * depth * depth * depth / 12.0, lever = length - 0.01;
  const double force = 3.0 * bends * 0.95 * pressed / (lever * lever * lever);
  for (std::size_t k = 0; k < clamps.end.size(); ++k) {
    // Shear and the lean of the edge: measured 0.25 %.
    EXPECT_NEAR(clamps.end[k], force, 0.01 * force) << k;
    EXPECT_LT(clamps.most[k], 1.01 * clamps.end[k]) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Counts, StaticLeaves,
                         testing::Values(Leaves{2, 0.0, 0.1}, Leaves{3, 0.0, 0.1},
                                         Leaves{2, 0.0, 0.02}, Leaves{3, 0.0, 0.02}));

}  // namespace
}  // namespace abut::static_leaves_tests
