// Goal: corners and edges of two bodies meet: a corner on a corner, an edge across an edge or along
// it, a corner on an edge, in impact and pressed at rest; and one node between two partners.
// Oracles: energy; balance of momentum; mirrors; equilibrium.

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::corners_and_edges_tests {
namespace {

constexpr double speed = 0.01;  // of that of sound
const std::string leapfrog = "central_difference: {step: 0.0125}";
const std::string trapezoid = "newmark: {step: 0.0125}";

double radians(double degrees) { return degrees * std::acos(-1.0) / 180.0; }

Eigen::Matrix3d turn(double degrees, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(radians(degrees), axis).toRotationMatrix();
}

/// A brick of so many cells whose skin is its port, turned about its centre.
SolidText brick(const std::string& name, const std::vector<double>& lengths,
                const std::vector<int>& cells, const Eigen::Matrix3d& turned,
                const Eigen::Vector3d& centre, const std::string& integrator) {
  const int dim = static_cast<int>(lengths.size());
  std::string map;
  for (int i = 0; i < dim; ++i) {
    std::string row;
    for (int j = 0; j < dim; ++j)
      row += fmt::format("{}{} * ({} - {})", j == 0 ? "" : " + ", number(turned(i, j)), "xyz"[j],
                         number(0.5 * lengths[j]));
    map += fmt::format("{}\"{}\"", i == 0 ? "" : ", ", row);
  }
  return {.name = name,
          .dim = dim,
          .mesh = block_mesh(lengths, cells),
          .material = unit_law("linear_elastic", 0.3),
          .integrator = integrator,
          .position = {centre.data(), centre.data() + dim},
          .port = "skin",
          .side = "boundary",
          .keys = fmt::format("map: [{}], ", map)};
}

SolidText falling(SolidText body) {
  body.velocity.assign(index(body.dim), 0.0);
  body.velocity.back() = -speed;
  return body;
}

std::string finder(const std::string& side, const std::string& contact = "") {
  std::string rest = contact.empty() ? "" : fmt::format(", contact: {{{}}}", contact);
  if (!side.empty()) rest += fmt::format(", transmission: {{unilateral: {{kinematic: {}}}}}", side);
  return rest;
}

/// Roofs whose ridges lie across each other at an angle; `beside`: where the upper one's middle is.
std::array<SolidText, 2> ridges(double angle, const std::array<double, 2>& beside,
                                const std::string& integrator) {
  const std::vector<double> lengths = {0.4, 0.3, 0.3};
  const double height = 0.15 * std::sqrt(2.0);
  const Eigen::Matrix3d roof = turn(45.0, Eigen::Vector3d::UnitX());
  return {brick("low", lengths, {6, 5, 5}, roof, {0.0, 0.0, -height}, integrator),
          brick("up", lengths, {6, 5, 5}, turn(angle, Eigen::Vector3d::UnitZ()) * roof,
                {beside[0], beside[1], height + 0.004}, integrator)};
}

void expect_balanced(const RunResult& result, const std::string& integrator, double energy) {
  ASSERT_TRUE(result.completed());
  // Rounding; where bodies solve equations, 1e-9 of the forces.
  EXPECT_LE(result.measure("momentum.total"), integrator == leapfrog ? 1.0e-12 : 1.0e-9);
  EXPECT_LE(result.measure("energy.total.relative_drift_max"), energy);
}

TEST(EdgesThatCross, PressWhereTheyCross) {
  for (const std::string& integrator : {leapfrog, trapezoid})
    for (const double angle : {90.0, 60.0, 30.0})
      for (const std::array<double, 2>& beside : {std::array{0.013, 0.021}, {0.0, 0.0}})
        for (const std::string side : {"low.skin", "up.skin"}) {
          // In the middle of a cell and, as bricks of an even number of cells lie, at a node.
          if (beside[0] == 0.0 && (angle != 90.0 || side == "low.skin")) continue;
          if (integrator == trapezoid && side == "low.skin") continue;
          SCOPED_TRACE(fmt::format("{} {} {} {}", integrator, angle, beside[0], side));
          const auto [low, up] = ridges(angle, beside, integrator);
          const auto result = run_solids(3.0, 0.025, {low, falling(up)},
                                         touching("impact", "low.skin", "up.skin", finder(side)));
          expect_balanced(*result, integrator, 1.0e-4);  // the goal is 5e-4; measured 3e-5
          EXPECT_EQ(result->measure("contact.impact.closings"), 1.0);
          EXPECT_GT(result->measure("contact.impact.impulse"), 2.0e-4);
        }
}

TEST(EdgesThatCross, RubAndBelongToRigidBodiesToo) {
  auto [low, up] = ridges(90.0, {0.013, 0.021}, leapfrog);
  up.velocity = {0.003, 0.002, -speed};
  const auto rubs = run_solids(
      3.0, 0.025, {low, up}, "  impact: {sides: [low.skin, up.skin], contact: {friction: 0.3}}\n");
  expect_balanced(*rubs, leapfrog, 5.0e-4);
  EXPECT_GT(rubs->measure("contact.impact.dissipated"), 0.0);
  up.velocity = {0.0, 0.0, -speed};
  up.model = "rigid";
  up.integrator = "rigid_motion: {step: 0.0125}";
  const auto rigid = run_solids(3.0, 0.025, {low, up}, touching("impact", "low.skin", "up.skin"));
  expect_balanced(*rigid, leapfrog, 5.0e-4);
}

TEST(EdgesThatCross, CarryAStaticLoad) {
  auto [low, up] = ridges(90.0, {0.013, 0.021}, "quasi_static: {step: 0.5}");
  low.more = "    constraints: {base: {on: bottom, fixed: true}}\n";
  up.more = "    constraints: {grip: {on: front, x: \"0\", y: \"0\", z: \"-0.008 * t\"}}\n";
  const auto result = run_solids(1.0, 0.5, {low, up}, touching("press", "low.skin", "up.skin"));
  ASSERT_TRUE(result->completed());
  const double force = result->measure("body.up.grip.reaction.z");
  EXPECT_LT(force, -5.0e-5);                      // pressed by half of 0.008
  for (const std::string axis : {"x", "y", "z"})  // sums over some hundred nodes
    EXPECT_NEAR(result->measure("body.low.base.reaction." + axis),
                -result->measure("body.up.grip.reaction." + axis), roundoff(1.0e4, force));
}

TEST(EdgesAlongEachOther, Press) {
  const auto [low, up] = ridges(0.0, {0.013, 0.0}, leapfrog);
  const auto result =
      run_solids(3.0, 0.025, {low, falling(up)}, touching("impact", "low.skin", "up.skin"));
  expect_balanced(*result, leapfrog, 1.0e-3);  // 6e-4: a ridge on a ridge slips off to a side
  EXPECT_EQ(result->measure("contact.impact.closings"), 1.0);
}

struct Corners2D {
  double low, up;  // [deg] by which the squares are turned
  double beside;   // of the upper corner
  double energy;   // measured: half of it
};

/// Squares of 0.4, corner over corner.
ResultPtr corner_on_corner(const Corners2D& c, const std::string& integrator) {
  const auto extreme = [](double degrees, double way) {
    Eigen::Vector2d most(0.0, 0.0);
    const Eigen::Matrix3d turned = turn(degrees, Eigen::Vector3d::UnitZ());
    for (const double i : {-0.2, 0.2})
      for (const double j : {-0.2, 0.2}) {
        const Eigen::Vector2d x = (turned * Eigen::Vector3d(i, j, 0.0)).head<2>();
        if (way * x.y() > way * most.y()) most = x;
      }
    return most;
  };
  const Eigen::Vector2d top = extreme(c.low, 1.0), foot = extreme(c.up, -1.0);
  const SolidText low = brick("low", {0.4, 0.4}, {6, 6}, turn(c.low, Eigen::Vector3d::UnitZ()),
                              {-top.x(), -top.y(), 0.0}, integrator);
  const SolidText up = brick("up", {0.4, 0.4}, {6, 6}, turn(c.up, Eigen::Vector3d::UnitZ()),
                             {c.beside - foot.x(), 0.004 - foot.y(), 0.0}, integrator);
  return run_solids(3.0, 0.025, {low, falling(up)}, touching("impact", "low.skin", "up.skin"));
}

TEST(CornersOnCorners, KeepTheEnergyInThePlane) {
  for (const std::string& integrator : {leapfrog, trapezoid})
    for (const Corners2D& c : {Corners2D{45.0, 45.0, 0.0, 5.0e-5},
                               {45.0, 45.0, 0.003, 5.0e-5},
                               {34.0, 23.0, 0.01, 5.0e-5},
                               {17.0, 11.0, -0.01, 1.0e-4},
                               {52.0, 29.0, 0.004, 1.0e-4},
                               // Exactly on each other they slip off to one side.
                               {17.0, 11.0, 0.0, 1.0e-3},
                               {45.0, 29.0, 0.0, 1.7e-3}}) {
      SCOPED_TRACE(fmt::format("{} {} {} {}", integrator, c.low, c.up, c.beside));
      const auto result = corner_on_corner(c, integrator);
      expect_balanced(*result, integrator, c.energy);
      EXPECT_EQ(result->measure("contact.impact.closings"), 1.0);
    }
}

struct Corners3D {
  bool on_corner;  // else: on an edge
  double turned;   // [deg] of the upper cube about the vertical
  std::array<double, 2> beside;
  double energy;
};

/// Cubes of 0.3; the upper one falls with a corner first.
TEST(CornersOnCorners, KeepTheEnergyInSpace) {
  const Eigen::Matrix3d on_corner =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::Ones(), Eigen::Vector3d::UnitZ())
          .toRotationMatrix();
  const double to_corner = 0.15 * std::sqrt(3.0), to_edge = 0.15 * std::sqrt(2.0);
  // What slides over an edge or a corner gives up some energy there, as its force turns: the
  // coarser the cells, the more. Nothing gains more than half of what stops a run.
  for (const Corners3D& c : {Corners3D{true, 0.0, {0.004, 0.007}, 2.0e-3},
                             {true, 0.0, {0.02, 0.013}, 5.0e-4},
                             {true, 45.0, {0.004, 0.007}, 5.0e-4},
                             {true, 180.0, {0.004, 0.007}, 5.0e-4},
                             {true, 20.0, {0.02, 0.013}, 5.0e-4},
                             {false, 45.0, {0.004, 0.007}, 5.0e-4},
                             {false, 180.0, {0.02, 0.013}, 5.0e-4},
                             {false, 20.0, {0.004, 0.007}, 5.0e-4},
                             {false, 20.0, {0.02, 0.013}, 5.0e-4}}) {
    SCOPED_TRACE(fmt::format("{} {} {}", c.on_corner, c.turned, c.beside[0]));
    const std::vector<double> lengths(3, 0.3);
    const SolidText low = brick("low", lengths, {4, 4, 4},
                                c.on_corner ? on_corner : turn(45.0, Eigen::Vector3d::UnitX()),
                                {0.0, 0.0, c.on_corner ? -to_corner : -to_edge}, leapfrog);
    const SolidText up =
        brick("up", lengths, {4, 4, 4}, turn(c.turned, Eigen::Vector3d::UnitZ()) * on_corner,
              {c.beside[0], c.beside[1], to_corner + 0.004}, leapfrog);
    const auto result =
        run_solids(3.0, 0.025, {low, falling(up)}, touching("impact", "low.skin", "up.skin"));
    expect_balanced(*result, leapfrog, c.energy);
    EXPECT_EQ(result->measure("contact.impact.closings"), 1.0);
  }
}

/// A square with a corner down falls into the valley between two bodies: one node has two partners.
TEST(OneNodeBetweenTwo, PressesIntoAValley) {
  for (const std::string& integrator : {leapfrog, trapezoid})
    for (const double slope : {20.0, 40.0}) {
      SCOPED_TRACE(fmt::format("{} {}", integrator, slope));
      const auto base = [&](const std::string& name, double side) {
        const Eigen::Matrix3d turned = turn(-side * slope, Eigen::Vector3d::UnitZ());
        const Eigen::Vector3d corner = turned * Eigen::Vector3d(0.3 * side, 0.2, 0.0);
        return brick(name, {0.6, 0.4}, {9, 6}, turned, -corner, integrator);
      };
      const SolidText up = brick("up", {0.4, 0.4}, {6, 6}, turn(45.0, Eigen::Vector3d::UnitZ()),
                                 {0.0, 0.2 * std::sqrt(2.0) + 0.004, 0.0}, integrator);
      const auto result = run_solids(
          3.0, 0.025, {base("left", 1.0), base("right", -1.0), falling(up)},
          touching("l", "up.skin", "left.skin") + touching("r", "up.skin", "right.skin"));
      expect_balanced(*result, integrator, 1.0e-3);  // the goal is 5e-4; measured 5.6e-4, 1e-4
      EXPECT_LE(result->measure("schwarz.iterations_max"), 8.0);
      const double left = result->measure("contact.l.impulse");
      EXPECT_GT(left, 0.0);
      // Sums of both sides in another order, over hundreds of substeps.
      EXPECT_NEAR(result->measure("contact.r.impulse") / left, 1.0, 1.0e-9);
    }
}

/// A block falls across the joint of two others, one of which may lie a little lower.
TEST(OneNodeBetweenTwo, LiesAcrossAJoint) {
  for (const std::string& integrator : {leapfrog, trapezoid})
    for (const double friction : {0.0, 0.3})
      for (const double beside : {0.0, 0.031})
        for (const double lower : {0.0, 0.001}) {
          SCOPED_TRACE(fmt::format("{} {} {} {}", integrator, friction, beside, lower));
          const Eigen::Matrix3d straight = Eigen::Matrix3d::Identity();
          SolidText up =
              brick("up", {0.4, 0.3}, {6, 5}, straight, {beside, 0.154, 0.0}, integrator);
          up.velocity = {beside == 0.0 ? 0.0 : 0.003, -speed};
          const std::string law = fmt::format("contact: {{friction: {}}}", number(friction));
          const auto result = run_solids(
              3.0, 0.025,
              {brick("left", {0.5, 0.4}, {7, 6}, straight, {-0.250001, -0.2, 0.0}, integrator),
               brick("right", {0.5, 0.4}, {7, 6}, straight, {0.250001, -0.2 - lower, 0.0},
                     integrator),
               up},
              fmt::format("  l: {{sides: [up.skin, left.skin], {0}}}\n"
                          "  r: {{sides: [up.skin, right.skin], {0}}}\n",
                          law));
          // Flat faces close all their rows inside one step.
          expect_balanced(*result, integrator, 1.0e-3);
          EXPECT_LE(result->measure("schwarz.iterations_max"), 2.0);
          if (beside != 0.0 || lower != 0.0) continue;
          EXPECT_NEAR(result->measure("mean_velocity.up.end_x"), 0.0, roundoff(1000.0, speed));
          EXPECT_NEAR(result->measure("contact.r.impulse") / result->measure("contact.l.impulse"),
                      1.0, roundoff(1000.0, 1.0));
        }
}

}  // namespace
}  // namespace abut::corners_and_edges_tests
