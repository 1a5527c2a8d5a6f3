// Goal: contact that begins and ends inside one window is counted and measured as in short windows.
// Oracle: the same run in short windows; where a closed form is at hand, its times and force.
//
// Events are located inside substeps and what they move is paid at ends of windows: two substeps of
// the coarsest scheme bound what that is of a time, and their share of the contact what it is of an
// impulse.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::long_windows_tests {
namespace {

constexpr double two_substeps = 4.0e-7;  // [s]

struct Layer {
  std::string integrator, layer;
};

std::vector<Layer> layers() {
  std::vector<Layer> out;
  for (const int terms : {1, 6}) {
    out.push_back({explicit_scheme(1.0e-7, terms), "massless: {stiffness_factor: 1.4}"});
    out.push_back({explicit_scheme(1.0e-7, terms), "kick: {}"});
  }
  out.push_back({implicit_scheme("newmark", 2.0e-7), "massless: {}"});
  return out;
}

SceneText against_a_wall() {
  SceneText scene = two_bars();
  scene.bars.pop_back();
  scene.wall = SceneText::Wall{0.0, "left"};
  scene.interfaces = {{"left.right", "wall.left"}};
  scene.closed_form = false;
  return scene;
}

/// A bar hits two that touch, and the last one is short: it is pressed and let go while the first
/// contact lasts, and nothing else happens then.
SceneText short_last() {
  SceneText scene = two_bars();
  BarText& middle = scene.bars[1];
  middle.name = "middle";
  middle.length = 0.125;
  middle.position = middle.velocity = 0.0;
  middle.sides = {"left", "right"};
  scene.bars[0].position = -0.26;
  scene.bars.push_back(middle);
  scene.bars[2].name = "right";
  scene.bars[2].length = 0.025;
  scene.bars[2].position = 0.125;
  scene.bars[2].sides = {"left"};
  for (BarText& bar : scene.bars) bar.elements = static_cast<int>(std::lround(600.0 * bar.length));
  scene.interfaces = {{"left.right", "middle.left"}, {"middle.right", "right.left"}};
  scene.closed_form = false;
  scene.begin = 0.0;
  scene.end = 4.8e-4;
  return scene;
}

void expect_same_contact(const RunResult& other, const RunResult& reference,
                         const std::string& interface, const std::string& what) {
  const auto value = [&interface](const RunResult& run, const std::string& measure) {
    return run.measure("contact." + interface + "." + measure);
  };
  ASSERT_TRUE(other.completed() && reference.completed()) << what;
  EXPECT_EQ(value(reference, "count"), 1.0) << what;
  ASSERT_EQ(value(other, "count"), value(reference, "count")) << what;
  EXPECT_EQ(value(other, "closings"), value(reference, "closings")) << what;
  const double duration = value(reference, "duration");
  for (const char* time : {"begin", "end", "duration"})
    EXPECT_NEAR(value(other, time), value(reference, time), two_substeps) << time << " " << what;
  for (const char* force : {"force_mean", "impulse"}) {
    const double expected = value(reference, force);
    EXPECT_NEAR(value(other, force), expected, two_substeps / duration * expected)
        << force << " " << what;
  }
}

void expect_same_in_long_windows(SceneText scene, const std::vector<double>& windows) {
  for (const Layer& layer : layers()) {
    for (BarText& bar : scene.bars) {
      bar.integrator = layer.integrator;
      bar.layer = layer.layer;
    }
    scene.window = 1.0e-5;
    const ResultPtr reference = run(scene);
    for (const double window : windows) {
      scene.window = window;
      const ResultPtr other = run(scene);
      for (std::size_t i = 0; i < scene.interfaces.size(); ++i)
        expect_same_contact(
            *other, *reference, i == 0 ? "first" : "second",
            fmt::format("{} {}, window {:g}", layer.integrator, layer.layer, window));
    }
  }
}

TEST(LongWindows, PressingOfTwoBarsInOneIsAsInShortOnes) {
  expect_same_in_long_windows(two_bars(), {1.0e-4, 5.0e-4, 1.0e-3});
}

TEST(LongWindows, PressingOnAWallInOneIsAsInShortOnes) {
  expect_same_in_long_windows(against_a_wall(), {1.0e-4, 5.0e-4, 1.0e-3});
}

TEST(LongWindows, PressingOfAShortBarThatTouchesIsAsInShortOnes) {
  expect_same_in_long_windows(short_last(), {1.2e-4, 2.4e-4, 4.8e-4});
}

}  // namespace
}  // namespace abut::long_windows_tests
