// Goal: rigid bodies part as restitution says, wherever in a step they meet. Oracles: Newton's law
// of impact, momentum; Coulomb's law of what presses in all.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::rigid_restitution_tests {
namespace {

/// Of the speed: places are rounded, and what is near a surface is within 1e-3 of an edge of it,
/// where facets of a disk lean by as much of a turn; measured 5e-6.
constexpr double lean = 1.0e-5;

std::string law(double restitution, double friction = 0.0) {
  return fmt::format("{{friction: {}, restitution: {}}}", friction, restitution);
}

std::vector<double> along(int dim, int axis, double value) {
  std::vector<double> out(index(dim), 0.0);
  out[index(axis)] = value;
  return out;
}

SolidText rigid(const std::string& name, std::string mesh, double density,
                std::vector<double> position, std::vector<double> velocity) {
  return {.name = name,
          .dim = static_cast<int>(position.size()),
          .mesh = std::move(mesh),
          .material = fmt::format("linear_elastic: {{youngs_modulus: 1.0e9, poissons_ratio: "
                                  "0.3, density: {}}}",
                                  density),
          .integrator = "rigid_motion: {step: 0.001}",
          .position = std::move(position),
          .velocity = std::move(velocity),
          .port = "skin",
          .side = "boundary",
          .model = "rigid"};
}

const std::string disk = "disk: {radius: 0.1, core: 4, layers: 2}";

SolidText floor_of(int dim) {
  return tool("floor", block_in(dim, {4.0, dim == 2 ? 0.2 : 4.0, 0.2}, {1, 1, 1}),
              dim == 2 ? std::vector<double>{-2.0, -0.2} : std::vector<double>{-2.0, -2.0, -0.2},
              dim == 2 ? "top" : "front");
}

/// A disk falls on a floor; nine places in a step at which they meet.
TEST(Restitution, OfADiskOnAFloorIsThatOfTheSceneAtAnyPartOfAStep) {
  for (const double restitution : {0.0, 0.3, 0.5, 0.9, 1.0})
    for (int k = 0; k < 9; ++k) {
      SCOPED_TRACE(fmt::format("{} at {}", restitution, k));
      const auto result = run_solids(
          0.2, 0.001,
          {rigid("disk", disk, 1000.0, {0.0, 0.15 + 1.25e-4 * k}, {0.0, -1.0}), floor_of(2)},
          "  under: {sides: [disk.skin, floor.face], contact: " + law(restitution) + "}\n");
      ASSERT_TRUE(result->completed()) << result->end.reason;
      EXPECT_NEAR(result->measure("body.disk.velocity.y.mean"), restitution, lean);
    }
}

/// Two disks whose masses are one to three, head on.
TEST(Restitution, OfTwoDisksIsNewtonsLawOfImpact) {
  for (const double e : {0.0, 0.5, 1.0}) {
    SCOPED_TRACE(e);
    const auto result =
        run_solids(0.3, 0.001,
                   {rigid("one", disk, 1000.0, {0.0, 0.0}, {1.0, 0.0}),
                    rigid("two", disk, 3000.0, {0.30037, 0.0}, {-0.5, 0.0})},
                   "  them: {sides: [one.skin, two.skin], contact: " + law(e) + "}\n");
    ASSERT_TRUE(result->completed()) << result->end.reason;
    const double middle = (1.0 - 3.0 * 0.5) / 4.0;  // of both
    EXPECT_NEAR(result->measure("body.one.velocity.x.mean"), middle - 0.75 * e * 1.5, 2.0 * lean);
    EXPECT_NEAR(result->measure("body.two.velocity.x.mean"), middle + 0.25 * e * 1.5, 2.0 * lean);
  }
}

/// A brick falls flat, on two corners or four at once.
TEST(Restitution, OfABrickThatFallsFlatHasAllCornersPartAlike) {
  for (const int dim : {2, 3})
    for (const double e : {0.0, 0.5, 1.0}) {
      SCOPED_TRACE(fmt::format("{}D {}", dim, e));
      const std::string mesh = dim == 2 ? "rectangle: {lengths: [0.4, 0.2], elements: [1, 1], "
                                          "origin: centre}"
                                        : "box: {lengths: [0.4, 0.3, 0.2], elements: [1, 1, 1], "
                                          "origin: centre}";
      const auto result = run_solids(
          0.1, 0.001,
          {rigid("brick", mesh, 1000.0, along(dim, dim - 1, 0.1302), along(dim, dim - 1, -1.0)),
           floor_of(dim)},
          "  under: {sides: [brick.skin, floor.face], contact: " + law(e) + "}\n");
      ASSERT_TRUE(result->completed()) << result->end.reason;
      const std::string up = dim == 2 ? "y" : "z";
      // Corners share what sweeps leave: they end where places fit to a ten-thousandth of a step's
      // way, and the impact is over where velocities do to a millionth; measured 4e-5.
      EXPECT_NEAR(result->measure("body.brick.velocity." + up + ".max"), e, 1.0e-4);
      EXPECT_NEAR(result->measure("body.brick.velocity." + up + ".min"), e, 1.0e-4);
    }
}

/// Two halves, one of them light, joined in a wall across the brick: what falls is one body, whose
/// impulses of the joint are of the same step as those of the floor.
TEST(Restitution, OfJoinedHalvesIsThatOfTheWhole) {
  for (const int dim : {2, 3})
    for (const double e : {0.0, 0.5, 1.0})
      for (int k = 0; k < 3; ++k) {
        SCOPED_TRACE(fmt::format("{}D {} at {}", dim, e, k));
        const std::string mesh = dim == 2 ? "rectangle: {lengths: [0.2, 0.2], elements: [1, 1]}"
                                          : "box: {lengths: [0.2, 0.3, 0.2], elements: [1, 1, 1]}";
        const auto half = [&](const std::string& name, double density, double x, double height) {
          std::vector<double> at = along(dim, dim - 1, height);
          at[0] = x;
          return rigid(name, mesh, density, at, along(dim, dim - 1, -1.0));
        };
        const double height = 0.0301 + 3.0e-4 * k;
        SolidText left = half("left", 1000.0, -0.2, height);
        SolidText right = half("right", 300.0, 0.0, height);
        left.sides = {"right"};
        right.sides = {"left"};
        const auto result =
            run_solids(0.1, 0.001, {left, right, floor_of(dim)},
                       "  on_left: {sides: [left.skin, floor.face], contact: " + law(e) +
                           "}\n  on_right: {sides: [right.skin, floor.face], contact: " + law(e) +
                           "}\n  joint: {sides: [left.right, right.left], tied: {}}\n");
        ASSERT_TRUE(result->completed()) << result->end.reason;
        const std::string up = dim == 2 ? "y" : "z";
        // Of the speed of 1 m/s: joints are met to 1e-3 of the thickness of 2e-4 m, which in steps
        // of an impact, down to 3e-5 s, is so much; measured 6.6e-3.
        const double met = 1.0e-3 * 2.0e-4 / 3.0e-5 * 1.5;
        for (const std::string name : {"left", "right"})
          EXPECT_NEAR(result->measure("body." + name + ".velocity." + up + ".mean"), e, met);
      }
}

/// Slips all through the impact: friction is mu times what presses in all, (1 + e) m v.
TEST(Restitution, LeavesFrictionWhatPressesInAll) {
  for (const double e : {0.0, 0.6})
    for (int k = 0; k < 4; ++k) {
      SCOPED_TRACE(fmt::format("{} at {}", e, k));
      const std::string flat =
          "rectangle: {lengths: [4.0, 0.02], elements: [1, 1], origin: centre}";
      const auto result = run_solids(
          0.1, 0.001,
          {rigid("plate", flat, 1000.0, {-1.0, 0.04 + 2.5e-4 * k}, {5.0, -1.0}),
           tool("floor", block_in(2, {40.0, 0.2, 0.2}, {1, 1, 1}), {-20.0, -0.2}, "top")},
          "  under: {sides: [plate.skin, floor.face], contact: " + law(e, 0.1) + "}\n");
      ASSERT_TRUE(result->completed()) << result->end.reason;
      // Friction acts .01 m below the middle, and turns the plate by 3e-4 of what it slows it by:
      // corners land one after the other.
      EXPECT_NEAR(result->measure("body.plate.velocity.x.mean"), 5.0 - 0.1 * (1.0 + e), 2.0e-3);
    }
}

/// What impacts take is told apart from what accuracy was given up.
TEST(Restitution, TellsWhatImpactsTook) {
  const auto result =
      run_solids(0.1, 0.001, {rigid("disk", disk, 1000.0, {0.0, 0.1303}, {0.0, -1.0}), floor_of(2)},
                 "  under: {sides: [disk.skin, floor.face], contact: " + law(0.5) + "}\n");
  ASSERT_TRUE(result->completed()) << result->end.reason;
  const double motion = 0.5 * result->masses[0];
  EXPECT_NEAR(result->end.given_up.impacts, 0.75 * motion, 2.0 * lean * motion);
}

/// What restitution takes back of a push, in the step after it, is no push. A box falls half a
/// metre and stays; so does its weight.
TEST(Restitution, ImpulsesAreTheMomentumThatTheyMade) {
  for (const std::string law : {"  under: {sides: [box.skin, floor.face], contact: {}}\n", ""}) {
    SolidText box = rigid("box", block_mesh({0.1, 0.1}, {2, 2}), 1000.0, {0.0, 0.503}, {0.0, 0.0});
    box.more = "    body_force: [0.0, -9.81]\n";
    box.integrator = "rigid_motion: {step: 0.002}";
    const double end = 0.4, weight = 10.0 * 9.81;
    const auto result = run_solids(end, 0.002, {box, floor_of(2)}, law,
                                   law.empty() ? "contact: {everything: {}}\n" : "");
    ASSERT_TRUE(result->completed()) << result->end.reason;
    const double made = 10.0 * result->measure("body.box.velocity.y.mean") + weight * end;
    const std::string name = law.empty() ? "everything" : "under";
    // Sums over 200 steps.
    EXPECT_NEAR(result->measure("contact." + name + ".impulse"), made, 1.0e-9 * made);
  }
}

}  // namespace
}  // namespace abut::rigid_restitution_tests
