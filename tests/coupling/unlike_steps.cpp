// Goal: steps that are not alike make no energy in contact, and which side finds it is of no weight
// that does not fall with the steps [M.127]. Oracles: energy of elastic bars, the two roles against
// each other.

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::unlike_steps_tests {
namespace {

constexpr double speed = 0.01;  // of that of sound

struct Facing {
  std::array<std::string, 2> schemes;
  std::array<double, 2> steps;  // [s]
  double window = 0.0;          // [s]
  double density = 1.0;         // of the second bar
  int cells = 8;

  double longest() const { return std::max(steps[0], steps[1]); }
};

/// The first bar flies at the second one, of unit length and modulus like itself.
ResultPtr run(const Facing& m, const std::string& finder, const std::string& more = "") {
  const auto bar = [&m](const std::string& name, int k, double place, double v,
                        const std::string& side) {
    const std::size_t at = index(k);
    const std::string law =
        fmt::format("linear_elastic: {{youngs_modulus: 1.0, poissons_ratio: 0.0, density: {}}}",
                    number(k == 0 ? 1.0 : m.density));
    return SolidText{
        .name = name,
        .mesh = block_mesh({1.0, 0.2}, {m.cells, 2 + k}),
        .material = law,
        .integrator = fmt::format("{}: {{step: {}}}", m.schemes[at], number(m.steps[at])),
        .position = {place},
        .velocity = {v},
        .side = side};
  };
  const std::string role =
      finder.empty() ? "" : ", transmission: {unilateral: {kinematic: " + finder + ".face}}";
  return run_solids(std::ceil(3.2 / m.window) * m.window, m.window,
                    {bar("a", 0, -1.0, speed, "right"), bar("b", 1, 1.3e-5, 0.0, "left")},
                    touching("impact", "a.face", "b.face", role) + more);
}

std::vector<Facing> meetings(int cells) {
  std::vector<Facing> all;
  const std::string by_drifts = "central_difference", newmark = "newmark";
  for (const double density : {1.0, 30.0})
    for (const std::string& a : {by_drifts, newmark})
      for (const std::string& b : {by_drifts, newmark})
        for (const auto& [ra, rb, common] : std::vector<std::array<int, 3>>{
                 {1, 2, 2}, {1, 4, 4}, {4, 1, 4}, {3, 7, 21}, {7, 3, 21}}) {
          // 0.4 of a cell's transit at most where steps are explicit, a fifth of it else
          const int most = std::max({1, a == by_drifts ? ra : 0, b == by_drifts ? rb : 0});
          const bool implicit = a == newmark && b == newmark;
          const double unit = (implicit ? 0.2 : 0.4 / most) / cells;
          all.push_back({{a, b}, {ra * unit, rb * unit}, common * unit, density, cells});
        }
  return all;
}

TEST(UnlikeSteps, MakeNoEnergyAndRolesDifferByTheLongerStepAtMost) {
  for (const int cells : {8, 32}) {
    for (const Facing& m : meetings(cells)) {
      SCOPED_TRACE(fmt::format("{} cells, {} of {} on {} of {}, density {}", cells, m.schemes[0],
                               m.steps[0], m.schemes[1], m.steps[1], m.density));
      const bool first = m.steps[0] < m.steps[1];
      const std::string guard = "schwarz: {energy_guard: 1.0}\n";
      const auto shorter = run(m, first ? "a" : "b"), longer = run(m, first ? "b" : "a", guard);
      ASSERT_TRUE(shorter->completed());
      ASSERT_TRUE(longer->completed());
      // Steps in transits of a bar, half of the contact. Equal ones leave 0.0017 of 8 cells.
      const double step = m.longest();
      EXPECT_LE(shorter->measure("energy.total.relative_drift_end"), 0.002 * 8 / cells);
      EXPECT_GE(shorter->measure("energy.total.relative_drift_end"), -0.1 * step);
      EXPECT_LE(longer->measure("energy.total.relative_drift_end"), 0.002 + 0.2 * step);
      EXPECT_NEAR(shorter->velocity(0), longer->velocity(0), 0.1 * step * speed);
      EXPECT_EQ(shorter->measure("schwarz.iterations_max"), 1.0);
    }
  }
}

bool warned(const RunResult& result) {
  for (const RunEvent& event : result.events)
    if (event.kind == RunEvent::Kind::warning &&
        event.text.find("times as long") != std::string::npos)
      return true;
  return false;
}

/// And a scene that has the other one find it is told so.
TEST(UnlikeSteps, LetTheSideOfTheShorterOnesFindTheContact) {
  Facing m{{"newmark", "newmark"}, {0.0125, 0.125}, 0.125, 1000.0, 8};
  for (const bool first : {true, false}) {
    if (!first) std::swap(m.steps[0], m.steps[1]);
    const auto open = run(m, ""), shorter = run(m, first ? "a" : "b"),
               longer = run(m, first ? "b" : "a", "schwarz: {energy_guard: 1.0}\n");
    ASSERT_TRUE(open->completed());
    EXPECT_EQ(open->rows.back().momentum, shorter->rows.back().momentum);
    EXPECT_FALSE(warned(*open));
    EXPECT_TRUE(warned(*longer));
    EXPECT_NEAR(open->measure("energy.total.relative_drift_max"), 0.0, 0.005);
  }
}

}  // namespace
}  // namespace abut::unlike_steps_tests
