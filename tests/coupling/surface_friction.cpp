// Goal: friction between bodies of any formulation, law, plane, integrator and pair of steps: what
// slides takes the coefficient's part of the pressing impulse and no more, what sticks takes no
// energy, and nothing is made or lost but what friction tells of.
// Oracles: Coulomb's law for the whole impact, which holds at every instant while all slides;
// balances of momentum and energy.

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::surface_friction_tests {
namespace {

struct Pair {
  std::string name;
  int dim = 2;
  std::string keys;         // of the model
  std::string material;     // of the left bar; the right one is linear where this one yields
  std::string left, right;  // integrators
  bool exact = true;        // explicit: momentum to round-off
};

void PrintTo(const Pair& pair, std::ostream* out) { *out << pair.name; }

/// Of that of sound: friction turns the bars, and normals lean by about as much.
constexpr double speed = 1.0e-4;

std::vector<Pair> pairs() {
  const std::string linear = unit_law("linear_elastic", 0.25);
  const std::string rubber = unit_law("neo_hookean", 0.25);
  const std::string j2 = unit_law("j2_plasticity", 0.25, ", yield_stress: 5.0e-5, hardening: 0.1");
  const auto step = [](const std::string& scheme, double length) {
    return fmt::format("{}: {{step: {}}}", scheme, number(length));
  };
  std::vector<Pair> out;
  for (const int dim : {2, 3})
    for (const std::string formulation : {"full", "one_point", "mean_dilatation"})
      for (const std::string plane : {"strain", "stress"})
        for (const std::string& material : {linear, rubber, j2})
          for (const std::string scheme : {"central_difference", "newmark", "generalized_alpha"}) {
            const std::string law = material.substr(0, material.find(':'));
            if (plane == "stress" && (dim == 3 || law == "j2_plasticity")) continue;
            if (plane == "stress" && formulation == "mean_dilatation") continue;
            if (formulation == "one_point" && scheme != "central_difference") continue;
            if (dim == 3 && law != "linear_elastic" && scheme != "central_difference") continue;
            const std::string in_plane = dim == 2 ? fmt::format("plane: {}, ", plane) : "";
            out.push_back({fmt::format("{}d_{}_{}_{}_{}", dim, dim == 2 ? plane : "space",
                                       formulation, law, scheme),
                           dim, fmt::format("{}formulation: {}, ", in_plane, formulation), material,
                           step(scheme, 0.0125), step(scheme, 0.0125),
                           scheme == "central_difference"});
          }
  for (const int dim : {2, 3})
    for (const std::string a : {"central_difference", "newmark"})
      for (const std::string b : {"central_difference", "newmark"})
        for (const double ratio : {0.2, 0.4, 1.0}) {
          const std::string times = fmt::format("{:g}", 10.0 * ratio);
          out.push_back({fmt::format("{}d_{}_on_{}_{}_tenths", dim, a, b, times), dim, "", linear,
                         step(a, 0.0125), step(b, 0.0125 * ratio), false});
          out.push_back({fmt::format("{}d_{}_{}_tenths_on_{}", dim, a, times, b), dim, "", linear,
                         step(a, 0.0125 * ratio), step(b, 0.0125), false});
        }
  return out;
}

/// Bars of a length of 1 hit each other with their ends, which slide past each other.
ResultPtr impact(const Pair& pair, double along, const std::string& friction) {
  // In space as few cells across as do not match; a face that yields leans by its cells.
  const int less = pair.dim == 3 && !pair.material.starts_with("j2") ? 1 : 0;
  const auto bar = [&pair, along, less](const std::string& name, int across, double way) {
    return SolidText{
        .name = name,
        .dim = pair.dim,
        .mesh = bar_mesh(pair.dim, across - less),
        .material = way < 0.0 && pair.material.starts_with("j2") ? unit_law("linear_elastic", 0.25)
                                                                 : pair.material,
        .integrator = way > 0.0 ? pair.left : pair.right,
        .position = {way > 0.0 ? -1.0 : 0.2 * speed},
        .velocity = {way * speed, way * along, pair.dim == 3 ? 0.5 * way * along : 0.0},
        .side = way > 0.0 ? "right" : "left",
        .keys = pair.keys};
  };
  return run_solids(3.0, 0.025, {bar("left", 2, 1.0), bar("right", 3, -1.0)},
                    fmt::format("  impact: {{sides: [left.face, right.face], contact: {{friction: "
                                "{}}}}}\n",
                                friction));
}

class SurfaceFriction : public testing::TestWithParam<Pair> {};
INSTANTIATE_TEST_SUITE_P(Combinations, SurfaceFriction, testing::ValuesIn(pairs()),
                         [](const auto& c) { return c.param.name; });

TEST_P(SurfaceFriction, TakesItsPartOfTheImpulseWhereAllSlides) {
  const Pair& pair = GetParam();
  constexpr double friction = 0.05, along = speed;
  const auto result = impact(pair, along, "0.05");
  ASSERT_TRUE(result->completed());
  // As without friction: Newton's method leaves 1e-9 of the forces, unlike steps exchange means.
  EXPECT_LE(result->measure("momentum.total"), pair.exact ? 2.0e-12 : 1.0e-8);
  EXPECT_NEAR(result->measure("energy.total.relative_drift_end"), 0.0, 2.0e-3);
  const double mass = pair.dim == 2 ? 0.25 : 0.0625;
  const auto change = [&](const char* axis, double begin) {
    return result->measure(std::string("momentum.left.end_") + axis) - mass * begin;
  };
  const double pressed = -change("x", speed), y = change("y", along);
  const double z = pair.dim == 3 ? change("z", 0.5 * along) : 0.0;
  EXPECT_GT(pressed, 1.2 * mass * speed);
  // Normals lean by 2e-4, of a friction of 0.05, and by 4e-4 where a face yields.
  EXPECT_NEAR(std::hypot(y, z), friction * pressed, 1.0e-2 * friction * pressed);
  if (pair.dim == 3) {
    EXPECT_NEAR(z, 0.5 * y, 1.0e-2 * std::abs(y));  // as much as their sum
  }
  EXPECT_GT(result->measure("contact.impact.dissipated"), 0.0);
}

TEST_P(SurfaceFriction, TakesNothingWhereAllSticks) {
  const Pair& pair = GetParam();
  const auto result = impact(pair, 0.02 * speed, "rough");
  ASSERT_TRUE(result->completed());
  // Rounding; where bodies solve equations, 1e-9 of the forces in every step.
  EXPECT_LE(result->measure("momentum.total"), pair.exact ? 2.0e-12 : 1.0e-8);
  EXPECT_NEAR(result->measure("energy.total.relative_drift_end"), 0.0, 2.0e-3);
  // Rows that part give up half a step of the shear that they held; faces that yield flow apart.
  if (pair.material.starts_with("j2")) return;
  const double kinetic = (pair.dim == 2 ? 0.25 : 0.0625) * speed * speed;
  EXPECT_NEAR(result->measure("contact.impact.dissipated"), 0.0, 2.0e-3 * kinetic);
}

}  // namespace
}  // namespace abut::surface_friction_tests
