// Goal: sharp corners press on faces, whichever side finds the contact and whether the body with
// the corner deforms. Oracles: energy; balance of momentum; a corner that is above a face touches
// it, and leaves it again. Rows of the face's nodes alone let a rigid corner at 45 degrees through
// by a quarter of a facet, unseen, and gave +46 % of the energy at 17 degrees.

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::surfaces_with_edges_tests {
namespace {

struct Fall {
  std::string name;
  int dim = 2;
  std::string body, integrator;  // of the brick
  double tilt = 0.0;             // [rad]
  std::string base;              // integrator of what it falls on
};

void PrintTo(const Fall& fall, std::ostream* out) { *out << fall.name; }

constexpr double speed = 0.01;  // of that of sound

/// A brick of 0.4 x 0.3, its lowest corner 0.004 above a block of 1 x 0.4, which is free.
ResultPtr run(const Fall& fall) {
  const bool plane = fall.dim == 2;
  const double c = std::cos(fall.tilt), s = std::sin(fall.tilt);
  const std::string up = plane ? "y" : "z";
  const std::string turned = fmt::format("{} * (x - 0.2) - {} * {}", number(c), number(s), up);
  const std::string lifted = fmt::format("{} * (x - 0.2) + {} * {} + {}", number(s), number(c), up,
                                         number(0.2 * std::abs(s) + 0.004));
  const std::string map = plane ? fmt::format("[\"{}\", \"{}\"]", turned, lifted)
                                : fmt::format("[\"{}\", \"y\", \"{}\"]", turned, lifted);
  std::vector<double> down(index(fall.dim), 0.0);
  down.back() = -speed;
  const SolidText brick{
      .name = "brick",
      .dim = fall.dim,
      .mesh = plane ? block_mesh({0.4, 0.3}, {6, 5}) : block_mesh({0.4, 0.2, 0.3}, {6, 3, 5}),
      .material = unit_law("linear_elastic", 0.3),
      .integrator = fall.integrator,
      .velocity = down,
      .port = "skin",
      .side = "boundary",
      .model = fall.body,
      .keys = fmt::format("map: {}, ", map)};
  const SolidText base{
      .name = "base",
      .dim = fall.dim,
      .mesh = plane ? block_mesh({1.0, 0.4}, {14, 6}) : block_mesh({1.0, 0.5, 0.4}, {14, 7, 6}),
      .material = unit_law("linear_elastic", 0.3),
      .integrator = fall.base,
      .position = plane ? std::vector{-0.5, -0.4} : std::vector{-0.5, -0.15, -0.4},
      .side = plane ? "top" : "front"};
  return run_solids(3.0, 0.025, {brick, base},
                    touching("impact", "brick.skin", "base.face",
                             ", transmission: {unilateral: {kinematic: base.face}}"));
}

std::vector<Fall> falls() {
  const std::string leapfrog = "central_difference: {step: 0.0125}";
  const std::string trapezoid = "newmark: {step: 0.0125}";
  std::vector<Fall> out;
  for (const int dim : {2, 3})
    for (const auto& [body, integrator] : std::vector<std::pair<std::string, std::string>>{
             {"rigid", "rigid_motion: {step: 0.0125}"}, {"fe", leapfrog}, {"fe", trapezoid}})
      for (const int tilt : {2, 17, 45})
        for (const std::string& base : {leapfrog, trapezoid})
          out.push_back({fmt::format("{}d_{}_{}_at_{}_on_{}", dim, body,
                                     integrator.substr(0, integrator.find(':')), tilt,
                                     base.substr(0, base.find(':'))),
                         dim, body, integrator, tilt * std::acos(-1.0) / 180.0, base});
  return out;
}

class SharpCorner : public testing::TestWithParam<Fall> {};
INSTANTIATE_TEST_SUITE_P(Falls, SharpCorner, testing::ValuesIn(falls()),
                         [](const auto& c) { return c.param.name; });

TEST_P(SharpCorner, PressesOnAFace) {
  const Fall& fall = GetParam();
  const auto result = run(fall);
  ASSERT_TRUE(result->completed());
  const bool both_explicit = (fall.body == "rigid" || fall.integrator.starts_with("central")) &&
                             fall.base.starts_with("central");
  // Rounding; where a body solves equations, 1e-9 of the forces.
  EXPECT_LE(result->measure("momentum.total"), both_explicit ? 1.0e-12 : 1.0e-9);
  const bool rattles = fall.body == "rigid" && fall.tilt < 0.1;
  // 6e-4 measured at most, but 2.1e-3 where a rigid face falls almost flat and rattles on a body
  // that is integrated by the trapezoidal rule: all its rows close inside one step.
  EXPECT_NEAR(result->energy_error(), 0.0, rattles ? 4.0e-3 : 1.0e-3);
  const std::size_t closings = result->times(RunEvent::Kind::contact_closed, "impact").size();
  EXPECT_GE(closings, 1u);
  EXPECT_LE(closings, rattles ? 2u : 1u);
  // Of the speed that it had, a blow beside its centre takes some for its spin.
  const std::string up = fall.dim == 2 ? "y" : "z";
  EXPECT_GT(result->measure("mean_velocity.brick.end_" + up), -0.5 * speed);
}

/// A brick of rubber of 0.2 x 0.1 falls spinning at `rate`, and lands on a corner wherever that is
/// then: facets on both sides of it come and go while it turns.
ResultPtr spin(int dim, double rate, bool rigid) {
  const bool plane = dim == 2;
  const double height = 0.14, fall = 0.015;
  const std::string up = plane ? "y" : "z";
  const std::string across = fmt::format("\"{} * ({} - {})\"", number(-rate), up, number(height));
  const std::string along = fmt::format("\"{} + {} * x\"", number(-fall), number(rate));
  SolidText brick{
      .name = "brick",
      .dim = dim,
      .mesh = plane ? block_mesh({0.2, 0.1}, {8, 4}) : block_mesh({0.2, 0.05, 0.1}, {8, 3, 4}),
      .material = unit_law("neo_hookean", 0.3),
      .integrator = "central_difference: {step: 0.004}",
      .port = "skin",
      .side = "boundary",
      .keys = plane ? "map: [\"x - 0.1\", \"y - 0.05\"], "
                    : "map: [\"x - 0.1\", \"y - 0.025\", \"z - 0.05\"], ",
      .field = plane ? across + ", " + along : across + ", \"0\", " + along};
  brick.position = plane ? std::vector{0.0, height} : std::vector{0.0, 0.0, height};
  SolidText base{
      .name = "base",
      .dim = dim,
      .mesh = plane ? block_mesh({0.4, 0.1}, {14, 4}) : block_mesh({0.4, 0.2, 0.1}, {14, 7, 4}),
      .position = plane ? std::vector{-0.2, -0.1} : std::vector{-0.2, -0.1, -0.1},
      .side = plane ? "top" : "front"};
  if (rigid) {
    base.model = "rigid_tool";
  } else {
    base.material = unit_law("neo_hookean", 0.3);
    base.integrator = brick.integrator;
  }
  return run_solids(3.0, 0.02, {brick, base}, touching("impact", "brick.skin", "base.face"));
}

TEST(SpinningCorner, HoldsWhileItTurns) {
  for (const int dim : {2, 3}) {
    for (const double rate : {0.2, 0.5}) {
      for (const bool rigid : {true, false}) {
        if (dim == 3 && !rigid) continue;  // brick_on_corner
        const auto result = spin(dim, rate, rigid);
        ASSERT_TRUE(result->completed()) << dim << " " << rate;
        EXPECT_GE(result->times(RunEvent::Kind::contact_closed, "impact").size(), 1u);
        // Measured 2e-5 on a rigid tool and 2.5e-3 where both bodies, of four cells across, swing
        // on; with the edge averaged over the facets beside it 20 %.
        EXPECT_NEAR(result->energy_error(), 0.0, rigid ? 1.0e-3 : 5.0e-3) << dim << " " << rate;
      }
    }
  }
}

}  // namespace
}  // namespace abut::surfaces_with_edges_tests
