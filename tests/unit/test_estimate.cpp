// Goal: what `abut check` tells before a run agrees with what the run then takes. Oracle: counts of
// hand-made scenes, and the exchanges of shipped scenes as measured (system tests compare them
// again).
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include <fmt/format.h>

#include "base/yaml_document.hpp"
#include "coordinator/estimate.hpp"
#include "coordinator/flight_work.hpp"
#include "coordinator/scene.hpp"

namespace abut::test_estimate {
namespace {

Scene two_bars(const std::string& more = {}) {
  const std::string text = R"(
meta: {title: estimate}
time: {begin: 0.0, end: 1.0e-3, window: 1.0e-5}
bodies: {left: {}, right: {}}
interfaces:
  impact: {sides: [left.tip, right.tip], contact: {}, transmission: {unilateral: {}}}
)" + more;
  return read_scene(Document::from_text("estimate.yaml", text, {}));
}

Description bar(double step) {
  Description body;
  body.name = "bar";
  body.dofs = 201;
  body.step = step;
  return body;
}

TEST(Estimate, CountsWindowsAndSubsteps) {
  const Description left = bar(1.0e-7);
  const Description right = bar(1.0e-6);
  const Description* bodies[] = {&left, &right};
  const Estimate e = estimate(two_bars(), bodies, 5.0e-4);
  EXPECT_EQ(e.windows, 100);
  EXPECT_EQ(e.contact_windows_low, 50);
  EXPECT_EQ(e.contact_windows_high, 50);
  EXPECT_EQ(e.bodies[0].substeps, 10000);
  EXPECT_EQ(e.bodies[1].substeps, 1000);
}

TEST(Estimate, HoldsWhatTheShippedSceneTakes) {
  const Description left = bar(1.0e-7);
  const Description* bodies[] = {&left, &left};
  const Estimate e = estimate(two_bars(), bodies, 5.0e-4);
  EXPECT_LE(e.exchanges_low, 118);   // two_bars.yaml: equal bars, one sweep in most windows
  EXPECT_GE(e.exchanges_high, 222);  // unequal_bars.yaml: two sweeps in most windows
}

/// Rows, steps of the force, kernel and calls.
TEST(Estimate, TellsOfTies) {
  Estimate e;
  Estimate::Ties ties;
  ties.joints = {{"joint", "left.face", 1.0e-6, 15}};
  ties.memory_mib = 2.5;
  ties.probes = 90;
  const auto told = [&e, &ties] {
    e.ties = {ties};
    return to_text(e);
  };
  EXPECT_NE(told().find("joint      15 rows, whose force is constant in the steps of left.face, "
                        "1e-06 s\n"),
            std::string::npos);
  EXPECT_NE(told().find("kernel of its rows on all rows: 2.5 MiB, 90 probes; 1 call of the bodies"),
            std::string::npos);
  ties.banded = true;
  EXPECT_NE(told().find("on near rows: 2.5 MiB, 90 probes; 1 to 3 calls"), std::string::npos);
  ties.linear = false;
  EXPECT_NE(told().find("1 to 4 calls of the bodies in a window, more where they deform much"),
            std::string::npos);
  ties.floats = true;
  EXPECT_NE(told().find("1 to 4 calls of the bodies in a window, the fewest where loads go on"),
            std::string::npos);
  ties.floats = false;
  ties.narrow = true;
  EXPECT_NE(told().find("2 calls of the bodies in a window and more"), std::string::npos);
  ties.used = false;
  EXPECT_NE(told().find("no kernel: 3 calls"), std::string::npos);
}

/// Copies of a body, and not two bodies that a reader compares.
TEST(Estimate, TellsManyEqualBodiesInOneLine) {
  Estimate e;
  for (const std::string name : {"a_1", "a_2", "a_3", "a_4", "b", "c_1", "c_2", "c_3"})
    e.bodies.push_back({name, name[0] == 'b' ? "modal" : "fe", true, 3, 5, 2.0});
  const std::string each = "fe; 3 degrees of freedom, 5 substeps, about 2.0 MiB in a process\n";
  const std::string text = to_text(e);
  EXPECT_EQ(text.substr(0, text.find("  windows")),
            "  a_1 to a_4, each of 4: " + each +
                "  b: modal; 3 degrees of freedom, 5 substeps, about 2.0 MiB in a process\n" +
                "  c_1: " + each + "  c_2: " + each + "  c_3: " + each);
}

TEST(Estimate, KnowsNothingOfContactWithoutAClosedForm) {
  const Description left = bar(1.0e-7);
  const Description* bodies[] = {&left, &left};
  const Estimate e = estimate(two_bars(), bodies, std::nullopt);
  EXPECT_EQ(e.contact_windows_low, 0);
  EXPECT_EQ(e.contact_windows_high, 100);
}

int flight(double window, const Description& body) {
  const Description* bodies[] = {&body};
  return windows_at_once(window, 1, bodies);
}

Description solid(std::int64_t dofs, double step, double stable_step) {
  Description body;
  body.dim = 3;
  body.dofs = dofs;
  body.step = step;
  body.stable_step = stable_step;
  return body;
}

TEST(Flight, TakesAsManyWindowsAsAreHalfASecondOfWork) {
  constexpr double none = std::numeric_limits<double>::infinity();
  Description explicit_bar = bar(1.0e-7);  // of 200 elements: what a reply may hold
  explicit_bar.stable_step = 1.0e-6;
  EXPECT_EQ(flight(1.0e-5, explicit_bar), 1000);
  // torsion_column.yaml: 1107 unknowns at 3 us, and a little more, ten steps to the window
  EXPECT_EQ(flight(1.0e-5, solid(1107, 1.0e-6, none)), 14);
  EXPECT_EQ(flight(1.0e-5, solid(3'000'000, 1.0e-6, none)), 1);  // a step of it takes longer
  EXPECT_EQ(flight(1.0e-5, solid(1'000'000, 1.0e-6, 2.0e-6)), 1);
  EXPECT_EQ(flight(1.0e-5, solid(10'000, 1.0e-6, 2.0e-6)), 100);
  EXPECT_EQ(flight(1.0, solid(0, 0.0, none)), 1000);  // a wall
  const Description one = solid(10'000, 1.0e-6, 2.0e-6);
  const Description* two[] = {&one, &one};
  EXPECT_EQ(windows_at_once(1.0e-5, 1, two), 50);
  // No more than a reply holds: u, v and f of 20,000 points in space are 1.4 MB a record.
  Description wall = solid(0, 0.0, none);
  wall.ports.emplace_back().geometry.points.resize(60'000);
  EXPECT_EQ(flight(1.0e-5, wall), 69);
  const Description* walls[] = {&wall};
  EXPECT_EQ(windows_at_once(1.0e-5, 7, walls), 9);
}

TEST(Estimate, CountsTheFlightsOfABodyThatNothingTouches) {
  Description column = solid(1107, 1.0e-6, std::numeric_limits<double>::infinity());
  const Description* bodies[] = {&column};
  const Scene scene = read_scene(Document::from_text("estimate.yaml", R"(
meta: {title: estimate}
time: {begin: 0.0, end: 1.0e-3, window: 1.0e-5}
bodies: {column: {}}
)", {}));
  const Estimate e = estimate(scene, bodies, std::nullopt);
  EXPECT_EQ(e.exchanges_low, 1 + 8);  // the begin; 100 windows, 14 at once
  EXPECT_EQ(e.exchanges_high, e.exchanges_low);
}

TEST(Estimate, EveryFeatureIsEitherInUseOrNotBuilt) {
  const Description left = bar(1.0e-7);
  const Description* bodies[] = {&left, &left};
  const Estimate plain = estimate(two_bars(), bodies, std::nullopt);
  const Estimate other = estimate(two_bars("schwarz: {form: parallel}\n"), bodies, std::nullopt);
  EXPECT_EQ(plain.in_use.size() + plain.not_built.size(),
            other.in_use.size() + other.not_built.size());
  EXPECT_EQ(plain.in_use.size() + 1, other.in_use.size());
}

TEST(Estimate, TellsTheMemoryOfKernels) {
  const std::string text = R"(
meta: {title: estimate}
time: {begin: 0.0, end: 1.0e-3, window: 1.0e-5}
bodies: {finder: {}, other: {}}
interfaces:
  impact: {sides: [finder.skin, other.skin], contact: {}, transmission: {unilateral: {KEY}}}
)";
  const auto with = [&text](const std::string& keys) {
    std::string scene = text;
    scene.replace(scene.find("KEY"), 3, keys);
    return read_scene(Document::from_text("estimate.yaml", scene, {}));
  };
  Description finder = bar(1.0e-6), other = bar(2.0e-6);
  int points = 1000;
  for (Description* body : {&finder, &other}) {
    body->name = body == &finder ? "finder" : "other";
    body->dim = 3;
    body->can.kernel = body->can.yielding = true;
    Port skin;
    skin.name = "skin";
    skin.geometry.dim = 3;
    skin.geometry.points.assign(static_cast<std::size_t>(3 * points), 0.0);
    body->ports = {skin};
    points = 2000;
  }
  const Description* bodies[] = {&finder, &other};
  // Two lists of numbers of 8 B for every pair of 3 x 2000 values and each of 5 substeps.
  const Estimate open = estimate(with(""), bodies, std::nullopt);
  ASSERT_EQ(open.kernels.size(), 1u);
  EXPECT_EQ(open.kernels[0].side, "other.skin");  // the larger of the two
  EXPECT_EQ(open.kernels[0].substeps, 5);
  EXPECT_DOUBLE_EQ(open.kernels[0].memory_mib, 16.0 * 5 * 6000.0 * 6000.0 / 1048576.0);
  // A quarter of the memory is enough for half of the points.
  const std::string quarter = fmt::format("kernel_memory: {}", open.kernels[0].memory_mib / 4.0);
  const Estimate bounded = estimate(with(quarter), bodies, std::nullopt);
  EXPECT_NEAR(static_cast<double>(bounded.kernels[0].points_that_fit), 1000.0, 1.0);
  const Estimate fixed = estimate(with("kinematic: other.skin"), bodies, std::nullopt);
  ASSERT_EQ(fixed.kernels.size(), 1u);
  EXPECT_EQ(fixed.kernels[0].side, "finder.skin");
  EXPECT_EQ(fixed.kernels[0].substeps, 10);
  finder.mass = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(estimate(with("kinematic: other.skin"), bodies, std::nullopt).kernels.empty());
}

}  // namespace
}  // namespace abut::test_estimate
