// Goal: how fast a contact closes is told along its normal: sliding has no part in it. Oracle: the
// velocities that the bodies start with.

#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::closing_speeds_tests {
namespace {

struct Case {
  double angle, sliding, friction;  // [rad] of the whole scene
  const char* finder;               // block.face | plate.face | auto
  bool on_corner;                   // the block stands on its corner
};

/// A block that comes down on a plate, both free, turned by an angle in the plane.
std::string scene(const Case& c) {
  const double s = std::sin(c.angle), k = std::cos(c.angle);
  const std::string turn =
      fmt::format("\"{0}*x - ({1})*y\", \"({1})*x + {0}*y\"", number(k), number(s));
  // 1e-3 above the plate, whose top is at y = 0.2 before the turn.
  const double x = 0.6, y = 0.201;
  const std::string block =
      c.on_corner
          ? fmt::format(
                "\"{0}*({2} + 0.7*x - 0.7*y) - ({1})*({3} + 0.7*x + 0.7*y)\", "
                "\"({1})*({2} + 0.7*x - 0.7*y) + {0}*({3} + 0.7*x + 0.7*y)\"",
                number(k), number(s), x, y)
          : fmt::format("\"{0}*({2} + x) - ({1})*({3} + y)\", \"({1})*({2} + x) + {0}*({3} + y)\"",
                        number(k), number(s), x, y);
  const auto body = [](const char* name, double length, const std::string& map, double vx,
                       double vy, const char* side) {
    return SolidText{
        .name = name,
        .material = "linear_elastic: {youngs_modulus: 1.0e4, poissons_ratio: 0.3, density: 1.0}",
        .integrator = "central_difference: {step: 1.0e-4}",
        .velocity = {vx, vy},
        .side = side,
        .keys = "map: [" + map + "], ",
        .block = {{length, 0.2}, {8, 4}}}
        .text();
  };
  const double v = c.sliding, w = -0.1;
  const std::string friction = c.friction > 0.0 ? fmt::format("friction: {}", c.friction) : "";
  return scene_text(
      0.02, 1.0e-3,
      body("block", 0.4, block, k * v - s * w, s * v + k * w, c.on_corner ? "boundary" : "bottom") +
          body("plate", 2.0, turn, 0.0, 0.0, "top"),
      fmt::format("interfaces: {{hit: {{sides: [block.face, plate.face], contact: {{{}}}, "
                  "transmission: {{unilateral: {{kinematic: {}}}}}}}}}\n",
                  friction, c.finder));
}

TEST(ClosingSpeeds, AreAlongTheNormal) {
  for (const double angle : {0.0, 0.5, -2.0}) {
    for (const double sliding : {0.0, 5.0}) {
      for (const double friction : {0.0, 0.4}) {
        for (const char* finder : {"auto", "block.face", "plate.face"}) {
          for (const bool on_corner : {false, true}) {
            const Case c{angle, sliding, friction, finder, on_corner};
            SCOPED_TRACE(
                fmt::format("{} {} {} {} {}", angle, sliding, friction, finder, on_corner));
            const auto run = run_text(scene(c));
            const auto closed = std::ranges::find_if(run->events, [](const RunEvent& event) {
              return event.kind == RunEvent::Kind::contact_closed;
            });
            ASSERT_NE(closed, run->events.end());
            // Bodies come as they started, to rounding of places over a step. Facets that were
            // pressed for a substep lean by 0.1 m/s x 1e-4 s over their length of 0.05 m, and what
            // slides along them closes.
            const double lean = 0.1 * 1.0e-4 / 0.05;
            EXPECT_NEAR(closed->values.at("closing_speed"), 0.1,
                        lean * sliding + roundoff(1000.0, 2.0) / 1.0e-4);
            if (sliding > 0.0) continue;
            EXPECT_NE(closed->text.find("closes at 0.1 m/s"), std::string::npos) << closed->text;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace abut::closing_speeds_tests
