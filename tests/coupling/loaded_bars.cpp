// Goal: loads on bars reach their partners: halves that are tied move as the whole bar does, and
// what pushes one bar moves both in contact.
// Oracles: the undivided bar under the same loads; the impulse of the loads.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::loaded_bars_tests {
namespace {

/// Keys of a body, put into a scene's text.
void give(std::string& text, const std::string& body, const std::string& keys) {
  const std::string head = "  " + body + ":\n";
  const std::size_t at = text.find(head);
  ASSERT_NE(at, std::string::npos);
  text.insert(at + head.size(), keys);
}

/// Wave speed, density and area 1, at rest.
BarText unit_bar(const std::string& name, int elements, const std::string& integrator) {
  return abut::unit_bar(name, elements / 80.0, elements, integrator);
}

const std::string everywhere = "wind: {acceleration: ['0.1 * cos(3 * x + t)']}";
const std::string at_left = "push: {on: left, pressure: '0.01 * sin(t)^2'}";
const std::string at_right = "pull: {on: right, traction: ['0.02 * sin(2 * t)^2']}";

std::string loads(const std::string& one, const std::string& other) {
  return "    loads: {" + one + ", " + other + "}\n";
}

SceneText scene_of(const std::vector<BarText>& bars) {
  SceneText scene;
  scene.closed_form = false;
  scene.bars = bars;
  scene.begin = 0.0;
  scene.end = 4.0;
  scene.window = 0.04;
  return scene;
}

double total_momentum(const RunResult& run) {
  double sum = 0.0;
  for (const double p : run.rows.back().momentum) sum += p;
  return sum;
}

TEST(LoadedHalves, MoveAsTheUndividedBar) {
  for (const std::string& scheme : {explicit_scheme(0.004), implicit_scheme("newmark", 0.004)}) {
    BarText a = unit_bar("a", 40, scheme), b = unit_bar("b", 40, scheme);
    b.position = 0.5;
    b.sides = {"left"};
    a.tied = "right";
    b.tied = "left";
    SceneText scene = scene_of({a, b});
    scene.tied = true;
    scene.interfaces = {{"a.right", "b.left"}};
    std::string divided = scene.text();
    give(divided, "a", loads(everywhere, at_left));
    give(divided, "b", loads(everywhere, at_right));
    BarText whole = unit_bar("whole", 80, scheme);
    whole.sides = {};
    std::string undivided = scene_of({whole}).text();
    give(undivided, "whole", loads(everywhere, at_left + ", " + at_right));
    const ResultPtr two = run_text(divided);
    const ResultPtr one = run_text(undivided);
    ASSERT_TRUE(two->completed() && one->completed()) << scheme;
    const RunResult::Row &halves = two->rows.back(), &bar = one->rows.back();
    const double energy = bar.total[0];
    // Iterations end at 1e-9 of the reference velocity times the step, in a hundred windows.
    const double left = 2.0 * iteration(1.0e-9, 100.0);
    EXPECT_NEAR(halves.total[0] + halves.total[1], energy, left * energy) << scheme;
    EXPECT_NEAR(total_momentum(*two), bar.momentum[0], left) << scheme;
    EXPECT_GT(std::abs(bar.momentum[0]), 1.0e-2) << scheme;
    EXPECT_LT(two->measure("energy.total.relative_drift_max"), left) << scheme;
  }
}

TEST(LoadedBar, PushesAnotherOneAhead) {
  // It starts in touch; the load of one moves both, and all of its impulse stays with them.
  for (const std::string& first : {explicit_scheme(0.004, 6), implicit_scheme("newmark", 0.004)}) {
    for (const std::string& second : {explicit_scheme(0.004), implicit_scheme("newmark", 0.008)}) {
      BarText a = unit_bar("a", 80, first), b = unit_bar("b", 60, second);
      b.position = 1.0 + 1.0e-6;
      b.sides = {"left"};
      SceneText scene = scene_of({a, b});
      scene.interfaces = {{"a.right", "b.left"}};
      std::string text = scene.text();
      give(text, "a", "    loads: {push: {on: left, pressure: '0.01 * t'}}\n");
      const ResultPtr r = run_text(text);
      SCOPED_TRACE(first + " " + second);
      ASSERT_TRUE(r->completed());
      EXPECT_NEAR(total_momentum(*r), 0.01 * 8.0, roundoff(2.0e4, 0.08));
      // Masses 1 and 0.75 under a force that grows
      EXPECT_NEAR(r->velocity(0), 0.08 / 1.75, 0.02);
      EXPECT_NEAR(r->velocity(1), 0.08 / 1.75, 0.02);
      EXPECT_NEAR(r->measure("energy.total.relative_drift_max"), 0.0,
                  0.004 * 0.004);  // second order
    }
  }
}

TEST(LoadedBar, HasNoExactSolution) {
  SceneText scene = two_bars();
  EXPECT_NO_THROW(run_text(scene.text()));
  std::string text = scene.text();
  give(text, "left", "    loads: {push: {on: left, pressure: '1'}}\n");
  try {
    run_text(text);
    ADD_FAILURE() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("meta.closed_form"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("the body left is neither"), std::string::npos);
  }
}

}  // namespace
}  // namespace abut::loaded_bars_tests
