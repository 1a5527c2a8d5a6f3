// Goal: joined surfaces move as one body would, whatever their meshes, steps and integrators, at
// one call of every body per window. Oracles: the energy identity [M.108], balance of momentum,
// the undivided body, linear fields, and order two in the step.

#include <array>
#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::tied_surfaces_tests {
namespace {

using Ties = std::vector<std::pair<std::string, std::string>>;

ResultPtr run(double end, double window, const std::vector<SolidText>& blocks, const Ties& ties,
              const std::string& rest = "", const std::string& keys = "") {
  std::string joints;
  for (std::size_t k = 0; k < ties.size(); ++k)
    joints += joined(fmt::format("tie{}", k), ties[k].first, ties[k].second, keys);
  return run_solids(end, window, blocks, joints, rest);
}

/// Two halves of a bar of length 2, the right one of finer steps, that shake in all directions. Of
/// explicit bodies steps of 0.02 are half the stable ones of the finest mesh here.
std::vector<SolidText> halves(const std::string& schemes, const std::vector<int>& across,
                              double fine, int dim = 2, double coarse = 0.02) {
  const std::string start = dim == 2 ? "velocity_field: [\"sin(2*x)\", \"cos(3*x)*0.3\"]"
                                     : "velocity_field: [\"sin(2*x)\", \"0.3*cos(3*x)\", \"x*y\"]";
  const auto of = [&](const std::vector<double>& plane) {
    std::vector<double> all = plane;
    if (dim == 3) all.push_back(all[1]);
    return all;
  };
  const auto cells = [&](int n) {
    return dim == 2 ? std::vector<int>{2 * n, n} : std::vector<int>{2 * n, n, n};
  };
  SolidText left{.name = "left",
                 .material = unit_law("linear_elastic", 0.25),
                 .integrator = scheme_named(schemes[0], coarse),
                 .position = {0.0},
                 .start = start,
                 .sides = {"right"},
                 .block = {of({1.0, 0.5}), cells(across[0])}};
  SolidText right = left;
  right.name = "right";
  right.integrator = scheme_named(schemes[1], fine);
  right.position = {1.0};
  right.sides = {"left"};
  right.block.cells = cells(across[1]);
  return {left, right};
}

const Ties middle = {{"left.right", "right.left"}};

/// Accumulated rounding of a run of some thousand steps, relative.
constexpr double rounding = 1.0e-11;

/// Of motions of the order of 1 over a thousand steps. Goal of the method: 1e-8 over 1e4.
constexpr double same_motion = 1.0e-9;

struct Combination {
  std::string schemes;
  double ratio;
  std::vector<int> across;
  int dim = 2;
};

void PrintTo(const Combination& c, std::ostream* out) {
  *out << fmt::format("{} {} {} {}d", c.schemes, c.ratio, fmt::join(c.across, ":"), c.dim);
}

std::vector<Combination> combinations() {
  std::vector<Combination> out;
  for (const char* schemes : {"II", "IE", "EI", "EE"}) {
    for (const double ratio : {1.0, 4.0, 7.3, 10.0})
      for (const std::vector<int>& across : {std::vector<int>{3, 3}, {2, 4}, {4, 3}, {6, 2}})
        out.push_back({schemes, ratio, across});
    for (const double ratio : {1.0, 1.5}) out.push_back({schemes, ratio, {2, 3}, 3});
  }
  return out;
}

class TiedPair : public testing::TestWithParam<Combination> {};
INSTANTIATE_TEST_SUITE_P(Combinations, TiedPair, testing::ValuesIn(combinations()));

/// Windows of ten coarse steps, nested or not.
TEST_P(TiedPair, KeepsEnergyAndMomentumInOneCallPerWindow) {
  const Combination& c = GetParam();
  const auto result = run(4.0, 0.2, halves(c.schemes, c.across, 0.02 / c.ratio, c.dim), middle);
  ASSERT_TRUE(result->completed());
  EXPECT_NEAR(result->measure("energy.total.relative_drift_max"), 0.0, rounding);
  // Newton's method leaves 1e-9 of the forces in every step of implicit bodies.
  EXPECT_LE(result->measure("momentum.total"), c.schemes == "EE" ? 1.0e-13 : 1.0e-8);
  EXPECT_EQ(result->measure("schwarz.iterations_max"), 2.0);  // the first window knows no trial
  EXPECT_LE(result->measure("schwarz.iterations_mean"), 1.05);
  // 1e-6 of what the sides move in a fine step: the tolerance of the iteration.
  EXPECT_LE(result->measure("contact.tie0.jump_max"), 1.0e-7 * 0.02);
}

/// Planes, rings among them, and how cells are integrated: the identity is of forces and motions.
TEST(TiedSurfaces, AnyPlaneAndFormulationKeepsEnergy) {
  for (const char* plane : {"strain", "stress", "axisymmetric"}) {
    for (const char* formulation : {"full", "one_point", "mean_dilatation"}) {
      if (plane == std::string("stress") && formulation == std::string("mean_dilatation")) continue;
      for (const char* schemes : {"II", "IE", "EI", "EE"}) {
        SCOPED_TRACE(fmt::format("{} {} {}", plane, formulation, schemes));
        std::vector<SolidText> blocks = halves(schemes, {2, 3}, 0.005);
        for (SolidText& block : blocks)
          block.keys = fmt::format("plane: {}, formulation: {}, ", plane, formulation);
        const auto result = run(2.0, 0.2, blocks, middle);
        ASSERT_TRUE(result->completed());
        EXPECT_NEAR(result->measure("energy.total.relative_drift_max"), 0.0, rounding);
        EXPECT_EQ(result->measure("schwarz.iterations_max"), 2.0);
      }
    }
  }
}

/// Contrasts of stiffness and density, windows of 1 to 100 steps.
TEST(TiedSurfaces, AnyContrastAndWindowTakeOneCall) {
  for (const double contrast : {1.0e-6, 1.0e-3, 1.0e3, 1.0e6}) {
    for (const int steps : {1, 10, 100}) {
      SCOPED_TRACE(fmt::format("{} {}", contrast, steps));
      std::vector<SolidText> blocks = halves("II", {3, 4}, 0.005);
      blocks[1].material =
          fmt::format("linear_elastic: {{youngs_modulus: {0}, poissons_ratio: 0.25, density: {0}}}",
                      number(contrast));
      const auto result = run(4.0, 0.02 * steps, blocks, middle);
      ASSERT_TRUE(result->completed());
      const double windows = 200.0 / steps;
      EXPECT_NEAR(result->measure("schwarz.iterations_mean"), 1.0 + 1.0 / windows,
                  roundoff(2.0, 2.0));
      EXPECT_NEAR(result->measure("energy.total.relative_drift_max"), 0.0, rounding);
    }
  }
}

/// The body that is cut moves as the whole one: one scheme and step, nodes on nodes.
TEST(TiedSurfaces, CutBodyMovesAsTheWholeOne) {
  std::vector<SolidText> blocks = halves("II", {3, 3}, 0.02);
  SolidText whole = blocks[0];
  whole.name = "whole";
  whole.block.lengths[0] = 2.0;
  whole.block.cells[0] *= 2;
  const auto undivided = run_solids(20.0, 0.2, {whole});
  const auto divided = run(20.0, 0.2, blocks, middle);
  const double momentum =
      divided->measure("body.left.momentum.y") + divided->measure("body.right.momentum.y");
  EXPECT_NEAR(momentum, undivided->measure("body.whole.momentum.y"), same_motion);
  const double stored =
      divided->measure("body.left.energy.stored") + divided->measure("body.right.energy.stored");
  EXPECT_NEAR(stored, undivided->measure("body.whole.energy.stored"), same_motion);
}

/// Explicit bodies: where they are cut makes no difference.
TEST(TiedSurfaces, PlaceOfTheCutMakesNoDifference) {
  const auto cut = [](double at) {
    std::vector<SolidText> blocks = halves("EE", {3, 3}, 0.02);
    blocks[0].block.lengths[0] = at;
    blocks[1].block.lengths[0] = 2.0 - at;
    blocks[1].position[0] = at;
    blocks[0].block.cells[0] = static_cast<int>(std::lround(6 * at));
    blocks[1].block.cells[0] = 12 - blocks[0].block.cells[0];
    return run(20.0, 0.2, blocks, middle);
  };
  const auto one = cut(1.0), other = cut(0.5);
  for (const char* energy : {"stored", "kinetic"}) {
    const auto sum = [energy](const RunResult& run) {
      return run.measure(fmt::format("body.left.energy.{}", energy)) +
             run.measure(fmt::format("body.right.energy.{}", energy));
    };
    EXPECT_NEAR(sum(*one), sum(*other), same_motion);
  }
}

/// Differences between steps h, h/2, h/4 fall by four: of displacement, of velocity, and of the
/// force between the sides. This stands for the middle of a step of the left one and, between
/// unlike steps, alternates about its means over two of them, which are taken on to the end.
TEST(TiedSurfaces, AreOfSecondOrder) {
  for (const char* schemes : {"II", "IE", "EI", "EE"}) {
    for (const double ratio : {1.0, 4.0, 7.3}) {
      std::array<std::vector<double>, 3> ends;
      for (const double h : {0.02, 0.01, 0.005}) {
        std::vector<SolidText> blocks = halves(schemes, {2, 3}, h / ratio, 2, h);
        // smooth in the beginning, at rest at the joint: no mode beyond the step
        blocks[0].start = blocks[1].start =
            "velocity_field: [\"0.5*cos(1.5707963267948966*x)\", \"0\"]";
        const bool nested = ratio == 7.3;  // ten steps and seventy-three
        const auto result = run(1.0, nested ? 10.0 * h : h, blocks, middle);
        ends[0].push_back(result->measure("body.right.displacement.x.mean"));
        ends[1].push_back(result->measure("body.right.momentum.x"));
        if (nested) continue;
        const auto force = [&result, h](std::size_t back) {  // it alone moves the right half
          const std::size_t at = result->rows.size() - back;
          return (result->rows[at].momentum[1] - result->rows[at - 1].momentum[1]) / h;
        };
        ends[2].push_back(0.75 * (force(1) + force(2)) - 0.25 * (force(3) + force(4)));
      }
      for (std::size_t k = 0; k < ends.size(); ++k) {
        const std::vector<double>& e = ends[k];
        if (e.empty()) continue;
        const double order = std::log2(std::abs((e[0] - e[1]) / (e[1] - e[2])));
        // The next term of steps of a fifteenth of a transit; means reach four of them back.
        EXPECT_NEAR(order, 2.0, k == 2 ? 0.15 : 0.1) << schemes << " " << ratio << " " << k;
      }
    }
  }
}

/// With the force in the finer steps energy is kept, and the motion wrong: why it is not the rule.
TEST(TiedSurfaces, ForceInFinerStepsMovesWrongly) {
  const auto end = [](double h, const std::string& tied) {
    return run(1.0, 0.2, halves("II", {2, 2}, h / 4, 2, h), middle, "", tied);
  };
  const std::string what = "body.right.momentum.y";
  const double exact = end(0.0025, "")->measure(what);
  const auto wrong = end(0.02, "steps: finer");
  EXPECT_NEAR(wrong->measure("energy.total.relative_drift_max"), 0.0, rounding);
  const double coarse = std::abs(end(0.02, "")->measure(what) - exact);
  EXPECT_GT(std::abs(wrong->measure(what) - exact), 10.0 * coarse);
}

/// A uniform stretch between held ends is at rest, and stays so: any joint lets it through.
TEST(TiedSurfaces, LinearFieldsPass) {
  const auto stretched = [](const std::string& schemes, const std::vector<int>& across, int dim,
                            const std::vector<std::string>& cells) {
    std::vector<SolidText> blocks = halves(schemes, across, 0.01, dim);
    for (std::size_t k : {0u, 1u}) {
      blocks[k].start = dim == 2 ? "displacement_field: [\"0.01*x\", \"0\"]"
                                 : "displacement_field: [\"0.01*x\", \"0\", \"0\"]";
      blocks[k].block.element = cells[k];
      blocks[k].material = unit_law("linear_elastic", 0.0);
    }
    blocks[0].more = "    constraints: {end: {on: left, x: 0}}\n";
    blocks[1].more = "    constraints: {end: {on: right, x: 0.02}}\n";
    return run(2.0, 0.2, blocks, middle);
  };
  const auto check = [](const RunResult& result, const std::string& trace) {
    SCOPED_TRACE(trace);
    ASSERT_TRUE(result.completed());
    for (const char* body : {"left", "right"}) {
      for (const char* end : {"min", "max"}) {
        // 1 % of a modulus of one: 1e-10 of it
        EXPECT_NEAR(result.measure(fmt::format("body.{}.nodal_stress.xx.{}", body, end)), 0.01,
                    1.0e-12);
        EXPECT_NEAR(result.measure(fmt::format("body.{}.displacement.y.{}", body, end)), 0.0,
                    1.0e-12);
      }
    }
  };
  for (const char* schemes : {"II", "IE", "EE"}) {
    for (const std::vector<int>& across : {std::vector<int>{3, 3}, {2, 5}, {5, 3}})
      for (const char* cell : {"quad4", "tri3"})
        check(*stretched(schemes, across, 2, {"quad4", cell}),
              fmt::format("{} {} {}", schemes, fmt::join(across, ":"), cell));
    for (const char* cell : {"hex8", "tet4"})
      check(*stretched(schemes, {2, 3}, 3, {"hex8", cell}), fmt::format("{} {}", schemes, cell));
  }
}

/// Four bodies of unlike steps around a point, rows of them, and a ring: every port of a body
/// answers forces on every other one.
TEST(TiedSurfaces, NetsTakeOneCall) {
  // Linear: sides of unlike meshes agree, and nothing is lost to make velocities one.
  const std::string start = "velocity_field: [\"x - 2*y\", \"0.5*x + y\"]";
  const auto block = [&start](const std::string& name, double x, double y, int n, char scheme,
                              double step, const std::vector<std::string>& sides) {
    return SolidText{.name = name,
                     .material = unit_law("linear_elastic", 0.25),
                     .integrator = scheme_named(scheme, step),
                     .position = {x, y},
                     .start = start,
                     .sides = sides,
                     .block = {{1.0, 0.5}, {2 * n, n}}};
  };
  const auto check = [](const RunResult& result) {
    ASSERT_TRUE(result.completed());
    EXPECT_NEAR(result.measure("energy.total.relative_drift_max"), 0.0, rounding);
    EXPECT_EQ(result.measure("schwarz.iterations_max"), 2.0);
    EXPECT_LE(result.measure("schwarz.iterations_mean"), 1.06);
  };
  const Ties cross = {{"sw.right", "se.left"},
                      {"nw.right", "ne.left"},
                      {"sw.top", "nw.bottom"},
                      {"se.top", "ne.bottom"}};
  for (const std::vector<int>& n : {std::vector<int>{2, 2, 2, 2}, {2, 3, 4, 3}}) {
    for (const double unlike : {1.0, 0.5}) {
      check(*run(4.0, 0.2,
                 {block("sw", 0.0, 0.0, n[0], 'I', 0.02, {"right", "top"}),
                  block("se", 1.0, 0.0, n[1], 'E', 0.02 * unlike, {"left", "top"}),
                  block("nw", 0.0, 0.5, n[2], 'E', 0.01, {"right", "bottom"}),
                  block("ne", 1.0, 0.5, n[3], 'I', 0.02 * unlike, {"left", "bottom"})},
                 cross));
    }
  }
  for (const int count : {3, 8}) {
    std::vector<SolidText> row;
    Ties ties;
    for (int k = 0; k < count; ++k) {
      row.push_back(block(fmt::format("b{}", k), k, 0.0, 2 + k % 2, k % 3 == 0 ? 'E' : 'I',
                          k % 2 == 0 ? 0.02 : 0.005, {"left", "right"}));
      if (k > 0) ties.push_back({fmt::format("b{}.right", k - 1), fmt::format("b{}.left", k)});
    }
    check(*run(4.0, 0.2, row, ties));
  }
}

TEST(TiedSurfaces, JoinModalBodies) {
  for (const char* schemes : {"II", "EI"}) {
    std::vector<SolidText> blocks = halves(schemes, {3, 4}, 0.01);
    // At rest at the joint, where modes leave something out.
    blocks[0].start = "velocity_field: [\"sin(3.141592653589793*x)\", \"0\"]";
    blocks[1].start = "velocity: [0.0, 0.0]";
    blocks[1].model = "modal";
    blocks[1].keys = "modes: 12, ";
    const auto result = run(4.0, 0.2, blocks, middle);
    ASSERT_TRUE(result->completed());
    EXPECT_NEAR(result->measure("energy.total.relative_drift_max"), 0.0, rounding);
    EXPECT_EQ(result->measure("schwarz.iterations_max"), 2.0);
  }
}

/// A body that a tool moves: what drives the tool does the work.
TEST(TiedSurfaces, FollowTools) {
  for (const char* scheme : {"I", "E"}) {
    SCOPED_TRACE(scheme);
    std::vector<SolidText> blocks = halves(std::string(scheme) + "I", {2, 3}, 0.02);
    blocks[0].start = "velocity: [0.0, 0.0]";
    const SolidText tool{.name = "tool",
                         .position = {1.0, 0.0},
                         .model = "rigid_tool",
                         .keys = "way: [\"0.1*(1 - cos(t))\", \"0\"], ",
                         .sides = {"left"},
                         .block = {{1.0, 0.5}, {2, 1}}};
    const auto result = run(4.0, 0.02, {blocks[0], tool}, {{"left.right", "tool.left"}});
    ASSERT_TRUE(result->completed());
    // What the tool does, in straight lines over windows of a body's step, is told exactly.
    EXPECT_NEAR(result->measure("energy.total.relative_drift_max"), 0.0, 1.0e-9);
    EXPECT_NEAR(result->measure("body.left.right.displacement.x"), 0.1 * (1.0 - std::cos(4.0)),
                1.0e-9);
  }
}

/// A rigid body of one cell: every node of the face it joins goes with it, and it goes on as one.
TEST(TiedSurfaces, JoinRigidBodies) {
  for (const char* scheme : {"I", "E"}) {
    SCOPED_TRACE(scheme);
    std::vector<SolidText> blocks = halves(std::string(scheme) + "I", {3, 1}, 0.02);
    blocks[0].start = "velocity_field: [\"1 + sin(3.141592653589793*x)\", \"0\"]";
    blocks[1].start = "velocity: [1.0, 0.0]";
    blocks[1].model = "rigid";
    blocks[1].integrator = scheme_named('R', 0.02);
    const auto result = run(4.0, 0.2, blocks, middle);
    ASSERT_TRUE(result->completed());
    // Its kernel is that of a light push, known to 1e-8: the iteration stops at its tolerance, 1e-6
    // of what the sides move in a step, 4e-8 m.
    EXPECT_NEAR(result->measure("energy.total.relative_drift_max"), 0.0, 1.0e-7);
    EXPECT_LE(result->measure("schwarz.iterations_max"), 3.0);
    EXPECT_NEAR(result->measure("body.left.right.displacement.x"),
                result->measure("body.right.displacement.x.max"), 4.0e-8);
  }
}

/// A joint beside a contact on the same body, which an interface names or everything has.
TEST(TiedSurfaces, StandBesideContact) {
  const std::pair<std::string, std::string> ways[] = {
      {"impact", "  impact: {sides: [right.right, hit.left], contact: {}}\n"},
      {"everything", "contact: {everything: {}}\n"}};
  for (const char* schemes : {"II", "IE", "EI", "EE"}) {
    for (const auto& [name, contact] : ways) {
      SCOPED_TRACE(fmt::format("{} {}", schemes, name));
      std::vector<SolidText> blocks = halves(schemes, {2, 3}, 0.01);
      for (SolidText& block : blocks) block.start = "velocity: [0.01, 0.0]";
      blocks[1].sides = {"left", "right"};
      SolidText hit = blocks[1];
      hit.name = "hit";
      hit.position[0] = 2.001;
      hit.sides = {"left"};
      hit.start = "velocity: [0.0, 0.0]";
      const auto result = run(4.0, 0.1, {blocks[0], blocks[1], hit}, middle, contact);
      ASSERT_TRUE(result->completed());
      // Newton's method leaves 1e-9 of the forces in every step of implicit bodies.
      EXPECT_LE(result->measure("momentum.total"), 1.0e-8);
      // Contact of coarse explicit and implicit bodies leaves this much (TouchesAndParts).
      EXPECT_NEAR(result->measure("energy.total.relative_drift_end"), 0.0, 1.0e-3);
      EXPECT_GT(result->measure(fmt::format("contact.{}.impulse", name)), 0.0);
    }
  }
}

/// Velocities that differ across the joint at the start become one: the energy of what parts is
/// lost, momentum is not, and nothing rings.
TEST(TiedSurfaces, VelocitiesBecomeOne) {
  for (const char* schemes : {"II", "IE", "EI", "EE"}) {
    SCOPED_TRACE(schemes);
    std::vector<SolidText> blocks = halves(schemes, {2, 3}, 0.005);
    blocks[0].start = "velocity: [1.0, 0.0]";
    blocks[1].start = "velocity: [0.0, 0.0]";
    const auto result = run(0.2, 0.02, blocks, middle);
    // Newton's method leaves 1e-9 of the forces in every step of implicit bodies.
    EXPECT_LE(result->measure("momentum.total"), 1.0e-8);
    EXPECT_LT(result->measure("energy.total.relative_drift_end"), -0.01);
    // The faces of both: what was 1 m/s apart is within the front's dispersion.
    EXPECT_NEAR(result->measure("body.left.right.velocity.x"),
                result->measure("body.right.left.velocity.x"), 0.05);
  }
}

/// Large strains: the undeformed kernel is no longer exact, secants do the rest.
TEST(TiedSurfaces, FiniteStrainConverges) {
  for (const char* law : {"saint_venant_kirchhoff", "neo_hookean"}) {
    std::vector<SolidText> blocks = halves("EE", {2, 3}, 0.005);
    for (SolidText& block : blocks) {
      block.material = unit_law(law, 0.25);
      block.start = "velocity_field: [\"0.05*sin(2*x)\", \"0.03*cos(3*x)\"]";
    }
    const auto result = run(4.0, 0.1, blocks, middle);
    ASSERT_TRUE(result->completed()) << result->events.back().text;
    // What a single body of these steps and this law wobbles by: 2 % of strain, second order.
    EXPECT_NEAR(result->measure("energy.total.relative_drift_max"), 0.0, 5.0e-3);
    EXPECT_LE(result->measure("schwarz.iterations_mean"), 5.0);
  }
}

}  // namespace
}  // namespace abut::tied_surfaces_tests
