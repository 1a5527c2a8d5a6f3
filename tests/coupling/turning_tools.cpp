// Goal: tools that turn do to bodies what turning walls do: rollers drag by friction, paddles hit,
// whatever the method, and none passes through a small body unseen. Oracles: Newton's law, the
// balance of energy with the work of what turns the tool, a heavy body that spins alike, scenes
// that are turned or told in another order.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::turning_tools_tests {
namespace {

constexpr double gravity = 9.81;

/// A plank of 50 kg that rests on two rollers of radius .1 m, of so many elements along it.
ResultPtr plank(double friction, double spin, double end, int elements = 1) {
  const double step =
      2.0e-4;  // in which a corner of a roller goes less than a hundredth of a facet
  SolidText plank{.name = "plank",
                  .material =
                      "linear_elastic: {youngs_modulus: 1.0, poissons_ratio: 0.3, density: "
                      "1000.0}",
                  .integrator = fmt::format("rigid_motion: {{step: {}}}", step),
                  .position = {-0.5, 0.1},
                  .side = "bottom",
                  .model = "rigid",
                  .more = "    body_force: [0.0, -9.81]\n",
                  .block = {{1.0, 0.05}, {elements, 1}}};
  std::vector<SolidText> bodies{plank};
  for (const double x : {-0.25, 0.25})
    bodies.push_back({.name = x < 0.0 ? "left" : "right",
                      .mesh = "disk: {radius: 0.1, core: 32, layers: 4}",
                      .position = {x, 0.0},
                      .side = "boundary",
                      .model = "rigid_tool",
                      .keys = fmt::format("turn: {{angle: \"{} * t\"}}, ", -spin)});
  return run_solids(
      end, step, bodies,
      fmt::format("  one: {{sides: [plank.face, left.face], contact: {{friction: {0}}}}}\n"
                  "  two: {{sides: [plank.face, right.face], contact: {{friction: {0}}}}}\n",
                  friction));
}

double momentum(const RunResult& run, const std::string& body, const char* axis) {
  return run.measure("body." + body + ".momentum." + axis);
}

/// Friction pulls with mu N until the plank goes as fast as the rollers' surface.
TEST(TurningTools, RollersDragAPlank) {
  const double mass = 50.0;
  for (const double friction : {0.1, 0.2}) {
    SCOPED_TRACE(friction);
    const auto slides = plank(friction, 4.0, 0.06);
    ASSERT_TRUE(slides->completed()) << slides->end.reason;
    // What the plank gained upwards, hopping over corners, pressed as well.
    const double pressed = mass * gravity * 0.06 + momentum(*slides, "plank", "y");
    // Normals lean by half a facet, pi/128, either way: that much of a friction angle of mu.
    EXPECT_NEAR(momentum(*slides, "plank", "x"), friction * pressed, 5.0e-3 * friction * pressed);
    const auto rolls = plank(friction, 2.0, 0.3);
    ASSERT_TRUE(rolls->completed()) << rolls->end.reason;
    // The surface's speed, at corners and between them: cos(pi/128) is 1 - 3e-4; friction pulls to
    // and fro by mu g h in a step.
    EXPECT_NEAR(momentum(*rolls, "plank", "x") / mass, 0.2,
                3.0e-4 * 0.2 + 2.0 * friction * gravity * 2.0e-4);
    // What drives the rollers is there as motion, or friction and normal contact took it.
    const RunResult::Row& last = rolls->rows.back();
    const GivenUp& given_up = rolls->end.given_up;
    const double driven = last.work[0] + last.work[1] + last.work[2];
    EXPECT_GT(last.work[1], 0.1 * last.total[0]);
    EXPECT_NEAR(driven, last.total[0] + given_up.friction + given_up.normal - given_up.push_out,
                1.0e-9 * driven);  // sums over some thousand steps
  }
}

/// Nodes inside of its flat side catch on no corner of the rollers that pass them.
TEST(TurningTools, RollersDragAPlankWithNodesInItsFlatSide) {
  const double friction = 0.2, mass = 50.0;
  const auto slides = plank(friction, 4.0, 0.06, 40);
  ASSERT_TRUE(slides->completed()) << slides->end.reason;
  const double pressed = mass * gravity * 0.06 + momentum(*slides, "plank", "y");
  // Rows lean by half a facet, pi/128, while a node lies before it, and by what a surface may lean
  // from its normals, a tenth, just before: of the few nodes there, some hundredths of the time,
  // which is a hundredth or two of what friction does (measured 0.019). Rows that catch make a
  // fifth of it.
  EXPECT_NEAR(momentum(*slides, "plank", "x"), friction * pressed, 0.03 * friction * pressed);
}

/// Averages over facets that are coarse beside the rollers' press before anything touches: such
/// windows would make all of the energy that there is, and are gone passively.
TEST(TurningTools, APlankAboveRollersFallsFreely) {
  const double step = 1.0e-4, end = 20 * step, mass = 8.0;  // 0.1 mm is fallen in 45 steps
  for (const std::string scheme : {"newmark", "central_difference"}) {
    SCOPED_TRACE(scheme);
    std::vector<SolidText> bodies{
        {.name = "plank",
         .material = "neo_hookean: {youngs_modulus: 1.0e8, poissons_ratio: 0.3, density: 1000.0}",
         .integrator = fmt::format("{}: {{step: {}}}", scheme, scheme == "newmark" ? step : 1.0e-5),
         .position = {-0.2, 0.0501},
         .side = "bottom",
         .more = "    body_force: [0.0, -9.81]\n",
         .block = {{0.4, 0.02}, {40, 2}}}};
    for (const double x : {-0.1, 0.1})
      bodies.push_back({.name = x < 0.0 ? "left" : "right",
                        .mesh = "disk: {radius: 0.05, core: 16, layers: 2}",
                        .position = {x, 0.0},
                        .side = "boundary",
                        .model = "rigid_tool"});
    const auto falls = run_solids(end, step, bodies,
                                  "  one: {sides: [plank.face, left.face], contact: {}}\n"
                                  "  two: {sides: [plank.face, right.face], contact: {}}\n");
    ASSERT_TRUE(falls->completed()) << falls->end.reason;
    // Newton's iterations end at 1e-9 of the forces.
    EXPECT_NEAR(momentum(*falls, "plank", "y"), -mass * gravity * end,
                1.0e-8 * mass * gravity * end);
  }
}

/// On a flat tool that turns about an axis of space, in the accurate method: friction pulls along
/// the surface's velocity, its size is mu N.
TEST(TurningTools, TurntableDragsABlock) {
  const double friction = 0.3, end = 0.01, mass = 0.5;
  SolidText block{.name = "block",
                  .dim = 3,
                  .material =
                      "saint_venant_kirchhoff: {youngs_modulus: 1.0e7, poissons_ratio: 0.3, "
                      "density: 1000.0}",
                  .integrator = "newmark: {step: 2.0e-4}",
                  .position = {0.25, -0.05, 0.0},
                  .side = "back",
                  .more = "    body_force: [0.0, 0.0, -9.81]\n",
                  .block = {{0.1, 0.1, 0.05}, {2, 2, 2}}};
  SolidText table = tool("table", {{1.0, 1.0, 0.05}, {4, 4, 1}}, {-0.5, -0.5, -0.05}, "front",
                         "turn: {about: [0, 0, 0], axis: [0, 0, 2], angle: \"20 * t\"}, ");
  const auto run = run_solids(
      end, 2.0e-4, {block, table},
      fmt::format("  rest: {{sides: [block.face, table.face], contact: {{friction: {}}}}}\n",
                  friction));
  ASSERT_TRUE(run->completed()) << run->end.reason;
  EXPECT_EQ(run->end.given_up.windows, 0);
  const double pressed = mass * gravity * end + momentum(*run, "block", "z");
  const double pulled = std::hypot(momentum(*run, "block", "x"), momentum(*run, "block", "y"));
  // Directions of slip fan out by .1 m / .3 m over the block: their sum is shorter by
  // (.1/.3)^2 / 24 to twice that, by where it presses.
  EXPECT_LT(pulled, friction * pressed * (1.0 + 1.0e-3));
  EXPECT_GT(pulled, friction * pressed * (1.0 - 3.0 * std::pow(0.1 / 0.3, 2.0) / 24.0));
  EXPECT_GT(momentum(*run, "block", "y"), 0.99 * pulled);
}

/// A paddle from the origin along x, and a small block in its way.
struct Swing {
  double speed = 20.0, end = 1.0e-3, window = 1.0e-5;
  std::string block = "central_difference: {step: 1.0e-6}", model = "fe";
  std::string law = "saint_venant_kirchhoff";
  double up = 0.011;
  int cells = 8;
  double angle = 0.0;         // [rad] by which the scene is turned
  bool spins_freely = false;  // a heavy rigid body in the tool's place
  bool tool_first = false, swapped = false;
  bool meets_all = false;

  /// Nodes of a mesh turned about the origin.
  std::string turned(double x, double y) const {
    return fmt::format(
        "map: [\"{0} * (x + {2}) - {1} * (y + {3})\", \"{1} * (x + {2}) + {0} * (y + "
        "{3})\"], ",
        std::cos(angle), std::sin(angle), x, y);
  }
  SolidText small() const {
    return {.name = "block",
            .material = fmt::format("{}: {{youngs_modulus: 1.0e9, poissons_ratio: 0.0, density: "
                                    "1000.0}}",
                                    law),
            .integrator = block,
            .side = meets_all ? "boundary" : "bottom",
            .model = model,
            .keys = turned(0.46, up),
            .block = {{0.02, 0.02}, {cells, cells}}};
  }
  SolidText paddle() const {
    SolidText out{.name = "paddle",
                  .side = meets_all ? "boundary" : "top",
                  .model = spins_freely ? "rigid" : "rigid_tool",
                  .keys = turned(-0.5, -0.01),
                  .block = {{1.0, 0.02}, {40, 1}}};
    if (spins_freely) {
      out.material =
          "linear_elastic: {youngs_modulus: 1.0e9, poissons_ratio: 0.0, density: 1.0e14}";
      out.integrator = fmt::format("rigid_motion: {{step: {}}}", window);
      out.field = fmt::format("\"-{0} * y\", \"{0} * x\"", speed);
    } else {
      // A tenth of a radian is the most in a step.
      out.keys +=
          fmt::format("turn: {{angle: \"{} * t\"}}, step: {}, ", speed, std::min(window, 1.0e-4));
    }
    return out;
  }
  ResultPtr run() const {
    const std::vector<SolidText> bodies =
        tool_first ? std::vector{paddle(), small()} : std::vector{small(), paddle()};
    if (meets_all) return run_solids(end, window, bodies, "", "contact: {everything: {}}\n");
    return run_solids(end, window, bodies,
                      swapped ? "  hit: {sides: [paddle.face, block.face], contact: {}}\n"
                              : "  hit: {sides: [block.face, paddle.face], contact: {}}\n");
  }
};

std::array<double, 2> momenta(const RunResult& run) {
  return {momentum(run, "block", "x"), momentum(run, "block", "y")};
}

TEST(TurningTools, IsThatOfABodyThatSpins) {
  for (const char* scheme : {"central_difference: {step: 1.0e-6}", "newmark: {step: 2.0e-6}"}) {
    SCOPED_TRACE(scheme);
    Swing swing{.block = scheme};
    const auto turns = swing.run();
    swing.spins_freely = true;
    const auto spins = swing.run();
    ASSERT_TRUE(turns->completed() && spins->completed());
    const std::array<double, 2> p = momenta(*turns), q = momenta(*spins);
    EXPECT_GT(p[1], 0.4 * 9.0);  // .4 kg at the .47 m of the block, 9.4 m/s, and half again more
    // The heavy body is slowed by one part in 1e12; tolerance of the sweeps.
    for (const std::size_t i : {0u, 1u}) EXPECT_NEAR(p[i], q[i], 1.0e-8 * p[1]);
  }
}

TEST(TurningTools, TurnedScenesOrderAndRolesAreTheSame) {
  const auto plain = Swing().run();
  ASSERT_TRUE(plain->completed());
  const std::array<double, 2> p = momenta(*plain);
  const double angle = 37.0 * std::numbers::pi / 180.0;
  for (const bool turned : {false, true}) {
    for (const bool first : {false, true}) {
      for (const bool swapped : {false, true}) {
        SCOPED_TRACE(fmt::format("turned {} first {} swapped {}", turned, first, swapped));
        const Swing swing{.angle = turned ? angle : 0.0, .tool_first = first, .swapped = swapped};
        const auto run = swing.run();
        ASSERT_TRUE(run->completed());
        const std::array<double, 2> q = momenta(*run);
        const double c = std::cos(swing.angle), s = std::sin(swing.angle);
        // Meshes are rounded otherwise, by 1e-16 m of gaps that press with 1e9 Pa; tolerances of
        // sweeps beside.
        EXPECT_NEAR(q[0], c * p[0] - s * p[1], 1.0e-6 * p[1]);
        EXPECT_NEAR(q[1], s * p[0] + c * p[1], 1.0e-6 * p[1]);
      }
    }
  }
}

/// The paddle goes up to seven widths of the block in a window.
TEST(TurningTools, NothingPassesUnseen) {
  for (const double speed : {20.0, 300.0}) {
    for (const double window : {1.0e-5, 1.0e-3}) {
      for (const bool all : {false, true}) {
        for (const std::string kind : {"explicit", "implicit", "rigid"}) {
          Swing swing{.speed = speed, .end = 0.35 / speed, .window = window, .up = 0.11};
          swing.cells = 3;
          if (swing.end < window) continue;
          swing.meets_all = all;
          if (kind == "implicit") swing.block = "newmark: {step: 1.0e-5}";
          if (kind == "rigid") {
            swing.model = "rigid";
            swing.block = fmt::format("rigid_motion: {{step: {}}}", std::min(window, 1.0e-5));
          }
          SCOPED_TRACE(
              fmt::format("{} rad/s, window {}, everything {}, {}", speed, window, all, kind));
          const auto run = swing.run();
          ASSERT_TRUE(run->completed()) << run->end.reason;
          EXPECT_TRUE(run->end.overlaps.empty());
          // .4 kg are at the paddle's speed at least: it has gone .24 m, the block was .11 m away.
          const std::array<double, 2> p = momenta(*run);
          EXPECT_GT(std::hypot(p[0], p[1]), 0.8 * 0.4 * speed * 0.47);
          // What it has, the tool gave.
          const RunResult::Row& last = run->rows.back();
          const std::size_t tool = 1;
          EXPECT_GT(last.work[tool], 0.99 * last.total[0]);
        }
      }
    }
  }
}

/// Copies turn about points of their own, where these are told and where they are not.
TEST(TurningTools, CopiesTurnAboutTheirOwnPoints) {
  for (const char* about : {"", "about: [0.0, 0.0], "}) {
    const auto run = run_text(fmt::format(
        "meta: {{title: test}}\ntime: {{begin: 0.0, end: 0.01, window: 1.0e-4}}\nbodies:\n"
        "  block:\n"
        "    copies: {{grid: {{count: [2, 1], spacing: [3.0, 0.0]}}}}\n"
        "    model: {{fe: {{dimension: 2, mesh: {{rectangle: {{lengths: [0.2, 0.2], elements: [2, "
        "2]}}}}}}}}\n"
        "    material: {{linear_elastic: {{youngs_modulus: 1.0e6, poissons_ratio: 0.0, density: "
        "1000.0}}}}\n"
        "    integrator: {{newmark: {{step: 1.0e-4}}}}\n"
        "    initial: {{position: [0.7, 0.02]}}\n    ports: {{skin: {{side: bottom}}}}\n"
        "  paddle:\n"
        "    copies: {{grid: {{count: [2, 1], spacing: [3.0, 0.0]}}}}\n"
        "    model: {{rigid_tool: {{dimension: 2, mesh: {{rectangle: {{lengths: [2.0, 0.02], "
        "elements: [20, 1], origin: centre}}}}, turn: {{{}angle: \"5 * t\"}}}}}}\n"
        "    ports: {{face: {{side: top}}}}\n"
        "contact: {{everything: {{}}}}\n",
        about));
    ASSERT_TRUE(run->completed()) << run->end.reason;
    EXPECT_GT(momentum(*run, "block_1", "y"), 40.0 * 4.0);  // 40 kg at .8 m
    // Places are rounded: 3 m beside the first.
    for (const char* axis : {"x", "y"})
      EXPECT_NEAR(momentum(*run, "block_1", axis), momentum(*run, "block_2", axis),
                  roundoff(1.0e6, 160.0));
  }
}

}  // namespace
}  // namespace abut::turning_tools_tests
