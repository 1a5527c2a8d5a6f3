// Goal: rigid bodies that are joined move as one, however they spin, though each of their rows but
// a few is redundant. Oracle: the body that is not divided.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::tied_rigid_tests {
namespace {

/// A brick from `x` on, one cell for each .2 m of its length, that spins at `rate` [rad/s] about an
/// axis along none of its own, through the middle of two such bricks.
SolidText brick(const std::string& name, int dim, double x, int cells, double rate) {
  const std::string shape =
      dim == 2 ? fmt::format("rectangle: {{lengths: [{}, 0.2], elements: [{}, 1]}}", 0.2 * cells,
                             cells)
               : fmt::format("box: {{lengths: [{}, 0.3, 0.2], elements: [{}, 1, 1]}}", 0.2 * cells,
                             cells);
  const std::string field =
      dim == 2 ? fmt::format("'1 - {0} * (y - 0.1)', '{0} * x'", rate)
               : fmt::format("'{0} * (y - 0.15)', '{0} * (z - 0.1 - x)', '1 - {0} * (y - 0.15)'",
                             rate);
  SolidText out{.name = name,
                .dim = dim,
                .mesh = shape,
                .material = "linear_elastic: {youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: "
                            "1000.0}",
                .integrator = "rigid_motion: {step: 0.001}",
                .position = {x, 0.0},
                .port = "far",
                .side = "right",
                .model = "rigid",
                .field = field};
  if (dim == 3) out.position.push_back(0.0);
  return out;
}

TEST(TiedRigid, HalvesSpinAsTheWhole) {
  for (const int dim : {2, 3}) {
    for (const double rate : {0.0, 1.0e-3, 1.0, 20.0}) {
      SCOPED_TRACE(fmt::format("{}D {} rad/s", dim, rate));
      SolidText left = brick("left", dim, -0.2, 1, rate), right = brick("right", dim, 0.0, 1, rate);
      left.sides = {"right"};
      right.sides = {"left"};
      const auto result =
          run_solids(0.2, 0.001, {right, left, brick("whole", dim, -0.2, 2, rate)},
                     "  joint: {sides: [left.right, right.left], tied: {}}\n");
      ASSERT_TRUE(result->completed()) << result->end.reason;
      // Joints are met to 1e-9 m here. Forces at the ends of steps turn what they turn by a twelfth
      // of the square of a step's angle too far, as kicks in place of a pull that is there all the
      // time; the port is .25 m off the axis.
      const double angle = rate * 0.001, turned = rate * 0.2;  // [rad] in a step, in all
      const double tolerance = 2.0e-9 + 0.25 * turned * angle * angle / 12.0;
      for (const RunResult::Row& row : result->rows)
        EXPECT_NEAR(row.u[0], row.u[2], tolerance);
    }
  }
}

}  // namespace
}  // namespace abut::tied_rigid_tests
