// Goal: what the scenes of configs/bars show holds over ranges that are too wide for scenes: ratios
// of impedance, windows, ratios of steps, gaps.
// Oracle: the exact solution for bars in rows (docs/METHOD.md, section 10), itself checked against
// the tables of wave theory in tests/unit/test_bar_row.cpp.

#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::bars_in_rows_tests {
namespace {

constexpr int per_length = 100;            // elements
constexpr double cell = 1.0 / per_length;  // also the step at CFL 1: wave speeds are 1
constexpr double step = 0.5 * cell;

BarText unit_bar(const std::string& name, double position, double length, double velocity,
                 double impedance, const std::vector<std::string>& sides) {
  BarText bar;
  bar.name = name;
  bar.length = length;
  bar.elements = static_cast<int>(per_length * length + 0.5);
  bar.area = 1.0;
  bar.modulus = bar.density = impedance;
  bar.position = position;
  bar.velocity = velocity;
  bar.integrator = explicit_scheme(step, 6);
  bar.sides = sides;
  return bar;
}

/// A bar of length, impedance and velocity 1 that touches one at rest.
SceneText pair(double length, double impedance, double end, double window) {
  SceneText scene;
  scene.form = "bars: {}";
  scene.bars = {unit_bar("a", -1.0, 1.0, 1.0, 1.0, {"right"}),
                unit_bar("b", 0.0, length, 0.0, impedance, {"left"})};
  scene.interfaces = {{"a.right", "b.left"}};
  scene.begin = 0.0;
  scene.end = end;
  scene.window = window;
  return scene;
}

/// What dispersion leaves of a front in vibration at 100 elements: 0.1 % of its velocity jump.
constexpr double vibration = 1.5e-3;

struct Contrast {
  double ratio;      // Z2 / Z1
  const char* role;  // kinematic side
  const char* layer;
};

std::vector<Contrast> contrasts() {
  std::vector<Contrast> all;
  for (double ratio : {1e-6, 1e-4, 1e-2, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 10.0, 1e2, 1e4, 1e6}) {
    for (const char* role : {"auto", "a.right", "b.left"}) all.push_back({ratio, role, "kick: {}"});
    all.push_back({ratio, "auto", "massless: {stiffness_factor: 1.4}"});
  }
  return all;
}

class ImpedancesInRows : public testing::TestWithParam<Contrast> {};
INSTANTIATE_TEST_SUITE_P(Sweep, ImpedancesInRows, testing::ValuesIn(contrasts()));

TEST_P(ImpedancesInRows, CollideAsMassesDo) {  // table A4
  const Contrast& c = GetParam();
  SceneText scene = pair(1.0, c.ratio, 3.0, 10 * step);
  const bool exact = std::string(c.layer) == "kick: {}";
  for (BarText& bar : scene.bars) {
    bar.layer = c.layer;
    if (exact) bar.integrator = explicit_scheme(cell, 1);  // CFL 1
  }
  // Where the stiffer side is kinematic the iterate carries the tolerance into the force, and only
  // a force below 1e-9 ends the contact in the right step.
  if (exact) scene.schwarz = "tolerance: 1.0e-10";
  scene.transmission = fmt::format("unilateral: {{kinematic: {}}}", c.role);
  const ResultPtr r = run(scene);
  ASSERT_TRUE(r->completed());
  EXPECT_EQ(r->measure("contact.first.count_error"), 0.0);
  // A million to one in the wrong role leaves a residual of more than 1e-10 after one correction.
  EXPECT_LE(r->measure("schwarz.iterations_max"), exact && c.ratio == 1e6 ? 3.0 : 2.0);
  EXPECT_LT(r->momentum_error(), roundoff(1000, 1.0 + c.ratio));
  const double first = 2.0 * c.ratio / (1.0 + c.ratio), second = 2.0 / (1.0 + c.ratio);  // changes
  const double bound = exact ? 1e-9 : vibration;
  EXPECT_NEAR(r->velocity(0), 1.0 - first, bound * first);
  EXPECT_NEAR(r->velocity(1), second, bound * second);
  // 1e-10 in each of a hundred windows; or less than what velocities are off.
  EXPECT_NEAR(r->measure("contact.first.force_rms_error"), 0.0, exact ? 1e-8 : 1e-3);
}

TEST(WindowsInRows, AnyLengthGivesTheSameStaircase) {  // table A5, two steps of force
  std::vector<double> release, impulse;
  for (int steps : {1, 2, 5, 10, 20, 50, 100}) {
    const ResultPtr r = run(pair(2.0, 0.5, 6.0, steps * step));
    ASSERT_TRUE(r->completed()) << steps;
    EXPECT_EQ(r->measure("contact.first.count_error"), 0.0) << steps;
    EXPECT_LE(r->measure("schwarz.iterations_max"), 2.0) << steps;
    EXPECT_LT(r->momentum_error(), roundoff(1000, 1.0)) << steps;
    release.push_back(r->measure("contact.first.release_error"));
    impulse.push_back(r->measure("contact.first.impulse_error"));
  }
  for (std::size_t i = 1; i < release.size(); ++i) {
    // Iterations stop at 1e-6 of velocity times step, of either sign, in up to 800 windows.
    EXPECT_NEAR(release[i], release[0], iteration(1e-6, 10));
    EXPECT_NEAR(impulse[i], impulse[0], iteration(1e-6, 10));
  }
  EXPECT_NEAR(release[0], 0.0, 3e-3);  // half a cell of the 4 lengths that waves travel
  EXPECT_NEAR(impulse[0], 0.0, vibration);
}

/// How many steps of one bar are one of the other, and which bar has the small ones.
class StepsInRows : public testing::TestWithParam<std::tuple<int, int>> {};
INSTANTIATE_TEST_SUITE_P(Ratios, StepsInRows,
                         testing::Combine(testing::Values(1, 2, 3, 7, 10, 30, 100),
                                          testing::Values(0, 1)));

TEST_P(StepsInRows, AnyRatioGivesTheSameImpact) {
  const auto [ratio, fine] = GetParam();
  SceneText scene = pair(1.0, 0.5, 3.0, 10 * step);
  scene.bars[fine].integrator = explicit_scheme(step / ratio, 6);
  const ResultPtr r = run(scene);
  ASSERT_TRUE(r->completed());
  EXPECT_EQ(r->measure("contact.first.count_error"), 0.0);
  EXPECT_LE(r->measure("schwarz.iterations_max"), 2.0);
  EXPECT_LT(r->momentum_error(), roundoff(1000 * ratio, 1.0));
  EXPECT_NEAR(r->measure("contact.first.release_error"), 0.0, 3e-4);
  EXPECT_NEAR(r->measure("contact.first.impulse_error"), 0.0, vibration);
  EXPECT_NEAR(r->velocity(0), 1.0 / 3.0, vibration);
  EXPECT_NEAR(r->velocity(1), 4.0 / 3.0, vibration);
}

/// Of the first bar of a chain: the last and lightest one is hit so fast that speed 1, that of the
/// waves, would compress it to nothing. Gaps shrink with it, and times stay.
constexpr double slow = 0.1;

/// Four bars with gaps before each but the first.
SceneText chain(const std::vector<double>& gaps, const std::vector<double>& impedances,
                double window) {
  SceneText scene = pair(1.0, impedances[0], 10.0, window);
  scene.bars.resize(1);
  scene.bars[0].velocity = slow;
  scene.interfaces.clear();
  double position = 0.0;
  for (std::size_t b = 0; b < 3; ++b) {
    position += slow * gaps[b];
    const std::string name(1, static_cast<char>('b' + b));
    const std::string before(1, static_cast<char>('a' + b));
    const bool last = b == 2;
    scene.bars.push_back(unit_bar(
        name, position, 1.0, 0.0, impedances[b],
        last ? std::vector<std::string>{"left"} : std::vector<std::string>{"left", "right"}));
    scene.interfaces.push_back({before + ".right", name + ".left"});
    position += 1.0;
  }
  return scene;
}

TEST(ChainsInRows, OfAnyImpedanceFollowTheExactSolution) {
  const char* names[] = {"first", "second", "third"};
  for (const std::vector<double>& impedances :
       {std::vector<double>{1.0, 1.0, 1.0}, {0.5, 0.25, 0.125}, {2.0, 4.0, 8.0}, {3.0, 0.4, 2.0}}) {
    SceneText scene = chain({0.1, 0.2, 0.15}, impedances, 10 * step);
    const ResultPtr r = run(scene);
    ASSERT_TRUE(r->completed());
    for (const char* name : names) {
      const std::string contact = std::string("contact.") + name;
      EXPECT_EQ(r->measure(contact + ".count_error"), 0.0) << name << impedances[0];
      EXPECT_NEAR(r->measure(contact + ".begin_error"), 0.0, 5e-3) << name << impedances[0];
      EXPECT_NEAR(r->measure(contact + ".release_error"), 0.0, 5e-3) << name << impedances[0];
      EXPECT_NEAR(r->measure(contact + ".impulse_error"), 0.0, 5e-3) << name << impedances[0];
    }
    // Springs of the layers at closings and releases, of cells of 1 % at CFL 0.5: up to 1.3e-3.
    EXPECT_LT(r->measure("energy.total.relative_drift_max"), 2e-3);
    EXPECT_LT(r->momentum_error(), roundoff(1000, 10.0));
  }
}

}  // namespace
}  // namespace abut::bars_in_rows_tests
