// Goal: a window of contact at a point costs one sweep, whatever the pair: the trial without forces
// rides on the window before. Oracles: the count of sweeps, and runs that must agree.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::trials_ahead_tests {
namespace {

struct Pair {
  std::string name;
  SceneText scene;
};

std::vector<std::string> schemes(double step) {
  return {explicit_scheme(step, 1), implicit_scheme("newmark", step),
          fmt::format("generalized_alpha: {{step: {}, spectral_radius: 0.8}}", number(step))};
}

using Steps = std::vector<std::pair<double, double>>;

/// Every scheme before every other, equal and unequal bars.
std::vector<Pair> pairs(const Steps& steps) {
  std::vector<Pair> all;
  for (const auto& [left, right] : steps)
    for (const std::string& one : schemes(left))
      for (const std::string& other : schemes(right))
        for (const double times : {1.0, 3.0}) {
          SceneText scene = two_bars();
          scene.closed_form = false;
          scene.window = 6.0e-6;
          scene.begin = -3.0e-5;
          scene.end = 6.0e-4;
          scene.bars[0].position = -0.25 - 3.0e-3;
          scene.bars[1].position = 3.0e-3;
          scene.bars[0].integrator = one;
          scene.bars[1].integrator = other;
          scene.bars[1].modulus *= times;
          scene.bars[1].density *= times * times;
          all.push_back({one + " and " + other + ", " + number(times), scene});
        }
  return all;
}

/// Of windows in contact: more than one each.
double further_sweeps(const RunResult& result) {
  const double windows = result.measure("contact_windows");
  return windows * (result.measure("schwarz.iterations_mean") - 1.0);
}

TEST(TrialsAhead, OneSweepPerWindowOfEveryPair) {
  for (const bool parallel : {false, true}) {
    for (Pair& pair : pairs({{1.0e-7, 1.0e-7}, {5.0e-7, 1.0e-7}, {2.0e-7, 3.0e-7}})) {
      pair.scene.schwarz = parallel ? "form: parallel" : "";
      const auto result = run(pair.scene);
      ASSERT_TRUE(result->completed()) << pair.name;
      // Nobody looks on before the window in which the bars meet and the one that it is cut from,
      // nor over the windows before and after the cut at the release.
      EXPECT_LE(further_sweeps(*result), 4.0) << pair.name << (parallel ? ", parallel" : "");
      EXPECT_GT(result->measure("contact_windows"), 70.0) << pair.name;
      EXPECT_LT(result->momentum_error(), roundoff(10000, 1.0)) << pair.name;
    }
  }
}

}  // namespace
}  // namespace abut::trials_ahead_tests
