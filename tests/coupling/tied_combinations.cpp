// Goal: a divided body moves as the whole one whatever its law, plane, integrator, loads and
// supports; integrators that damp do so in joints too; calls stay few where nothing is linear.
// Oracles: the undivided body, the sign of what dissipates.

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::tied_combinations_tests {
namespace {

struct Law {
  std::string name, text;
  bool heats = false;
};

std::vector<Law> laws() {
  std::vector<Law> all;
  for (const char* law : {"linear_elastic", "saint_venant_kirchhoff", "neo_hookean", "hencky"})
    all.push_back({law, unit_law(law, 0.25)});
  all.push_back(
      {"mooney_rivlin", "mooney_rivlin: {c10: 0.1, c01: 0.1, bulk_modulus: 1.0, density: 1.0}"});
  all.push_back({"j2_plasticity",
                 unit_law("j2_plasticity", 0.25, ", yield_stress: 0.01, hardening: 0.1"), true});
  return all;
}

/// A bar of length 2, of 8 cells along, which shakes in all directions; a ring has radii 1 and 3.
struct Bar {
  Law law;
  std::string plane = "strain";  // or stress, axisymmetric, space
  std::string integrator, more = {};

  int dim() const { return plane == "space" ? 3 : 2; }
  std::string field() const {
    const std::string x = plane == "axisymmetric" ? "(x - 1)" : "x";
    return fmt::format("\"0.1*sin(2*{0})\", \"0.06*cos(3*{0})\"{1}", x,
                       dim() == 3 ? ", \"0.03*x*y\"" : "");
  }
  SolidText piece(const std::string& name, double from, double to,
                  const std::vector<std::string>& sides) const {
    const int along = static_cast<int>(std::lround(4.0 * (to - from)));
    const bool space = dim() == 3, locks = law.heats && plane != "stress";
    return {.name = name,
            .material = law.text,
            .integrator = integrator,
            .position = {from + (plane == "axisymmetric" ? 1.0 : 0.0)},
            .keys = (space ? "" : "plane: " + plane + ", ") +
                    (locks ? "formulation: mean_dilatation, " : ""),
            .field = field(),
            .sides = sides,
            .more = more,
            .block = {space ? std::vector{to - from, 0.5, 0.5} : std::vector{to - from, 0.5},
                      space ? std::vector{along, 2, 2} : std::vector{along, 3}}};
  }
};

const std::string tie = joined("tie", "a.right", "b.left");
const std::string sharp = "schwarz: {tolerance: 1.0e-9}\n";

ResultPtr whole(const Bar& bar) { return run_solids(1.0, 0.1, {bar.piece("a", 0.0, 2.0, {})}); }

ResultPtr divided(const Bar& bar, double at = 1.0) {
  return run_solids(1.0, 0.1,
                    {bar.piece("a", 0.0, at, {"right"}), bar.piece("b", at, 2.0, {"left"})}, tie,
                    sharp);
}

void expect_same(const RunResult& one, const RunResult& other, double tolerance) {
  ASSERT_TRUE(one.completed());
  ASSERT_TRUE(other.completed());
  const auto sum = [](const RunResult& run, const std::string& what) {
    double all = 0.0;
    for (const char* body : {"a", "b"})
      if (const auto at = run.measures.values.find(fmt::format("body.{}.{}", body, what));
          at != run.measures.values.end())
        all += at->second;
    return all;
  };
  for (const char* what :
       {"energy.stored", "energy.kinetic", "energy.dissipated", "momentum.x", "momentum.y"}) {
    SCOPED_TRACE(what);
    const double size = std::abs(sum(other, "energy.kinetic"));
    EXPECT_NEAR(sum(one, what), sum(other, what), tolerance * size);
  }
}

/// Of a whole implicit body the equations are the same ones; explicit ones take half drifts where
/// they are joined, so that the place of the cut makes no difference, and the scheme one of its own
/// order.
TEST(TiedCombinations, DividedBodiesMoveAsWholeOnesUnderEveryLaw) {
  for (const Law& law : laws()) {
    for (const char* plane : {"strain", "stress", "axisymmetric", "space"}) {
      SCOPED_TRACE(law.name + " " + plane);
      const Bar implicit{law, plane, "newmark: {step: 0.02}"};
      const auto one = whole(implicit);
      EXPECT_EQ(law.heats, one->measure("body.a.energy.dissipated") > 0.0);
      // Jumps of 1e-9 of a step's way, whose sum over 50 steps is less than as much of the motion.
      expect_same(*divided(implicit), *one, 1.0e-9);
      const Bar by_drifts{law, plane, "central_difference: {step: 0.01}"};
      const auto cut = divided(by_drifts);
      expect_same(*cut, *divided(by_drifts, 0.5), 1.0e-9);
      expect_same(*cut, *whole(by_drifts), 2.0e-3);  // (step / transit of a cell)^2
    }
  }
}

/// Loads, weight and supports that reach across the joint.
TEST(TiedCombinations, LoadsAndSupportsReachAcross) {
  for (const Law& law : laws()) {
    if (law.name != "linear_elastic" && law.name != "neo_hookean" && !law.heats) continue;
    for (const char* plane : {"strain", "axisymmetric", "space"}) {
      const std::string z = plane == std::string("space") ? ", 0" : "";
      for (const std::string& more :
           {"body_force: [0, -0.2" + z + "]",
            std::string("constraints: {f: {on: bottom, y: "
                        "\"0.05*sin(2*t)\"}}"),
            std::string("constraints: {f: {on: bottom, fixed: true}, l: {on: top, y: "
                        "\"0.02*sin(3*t)\"}}"),
            "loads: {p: {on: top, traction: [0, \"-0.05*t\"" + z + "]}}"}) {
        SCOPED_TRACE(law.name + " " + plane + " " + more);
        const Bar bar{law, plane, "newmark: {step: 0.02}", "    " + more + "\n"};
        expect_same(*divided(bar), *whole(bar), 1.0e-9);
      }
    }
  }
}

/// Integrators that damp keep accelerations, which jump with the forces of joints.
TEST(TiedCombinations, DampingIntegratorsGoOnAsInWholeBodies) {
  const std::vector<std::string> ways = {
      "hht_alpha: {alpha: -0.1, step: ", "generalized_alpha: {spectral_radius: 0.8, step: ",
      "generalized_alpha: {spectral_radius: 1, step: ",
      "newmark: {beta: 0.3025, gamma: 0.6, step: ", "newmark: {mass: lumped, step: "};
  for (const Law& law : laws()) {
    if (law.name != "linear_elastic" && law.name != "neo_hookean" && !law.heats) continue;
    for (const std::string& way : ways) {
      SCOPED_TRACE(law.name + " " + way);
      const Bar bar{law, "strain", way + "0.02}"};
      expect_same(*divided(bar), *whole(bar), 1.0e-9);
    }
  }
  // Of unlike ones no pair gains energy, at any ratio of steps, these far above a cell's transit.
  const Law linear = laws().front();
  for (const std::string& one : ways) {
    for (const std::string& other : ways) {
      for (const double ratio : {1.0, 4.0, 10.0}) {
        SCOPED_TRACE(fmt::format("{} {} {}", one, other, ratio));
        const Bar coarse{linear, "strain", one + "1.0}"};
        const Bar fine{linear, "strain", fmt::format("{}{}}}", other, number(1.0 / ratio))};
        const auto result = run_solids(
            100.0, 2.0,
            {coarse.piece("a", 0.0, 1.0, {"right"}), fine.piece("b", 1.0, 2.0, {"left"})}, tie);
        ASSERT_TRUE(result->completed());
        // Rounding of a thousand steps at most.
        EXPECT_LE(result->measure("energy.total.relative_drift_end"), 1.0e-10);
      }
    }
  }
}

/// The bent cantilever is let go, of laws of finite strain, windows of ten steps, meshes 4:6.
TEST(TiedCombinations, CallsStayFewWhereNothingIsLinear) {
  const std::string elastic = "youngs_modulus: 6.895e9, poissons_ratio: 0.25, density: 2768.0";
  const auto calls = [&elastic](const std::string& k, const std::string& n, const char* scheme,
                                double ratio) {
    const auto body = [&](const std::string& law, double step, int cells) {
      return SolidText{.material = fmt::format("{}: {{{}}}", law, elastic),
                       .integrator = implicit_scheme(scheme, step),
                       .start = "displacement_field: [\"0\", \"0.393701*x^2\"]",
                       .block = {{0.127, 0.0254}, {5 * cells, cells}}};
    };
    SolidText a = body(k, 1.0e-6, 4), b = body(n, 1.0e-6 / ratio, 6);
    a.name = "a";
    a.position = {0.0};
    a.sides = {"right"};
    a.more = "    constraints: {clamp: {on: left, fixed: true}}\n";
    b.name = "b";
    b.position = {0.127};
    b.sides = {"left"};
    const auto result = run_solids(2.0e-4, 1.0e-5, {a, b}, tie, "schwarz: {tolerance: 1.0e-3}\n");
    EXPECT_TRUE(result->completed());
    return result->measure("schwarz.iterations_mean");
  };
  const std::string bends = "saint_venant_kirchhoff", linear = "linear_elastic";
  // The method's goals are 3.5 and 2; measured are 3.7 to 3.8 and 2.9 to 3.0, by Newmark's rule 4.2
  // and 3.2: kernels of parts that are sheared by a tenth are wrong by some percent, which each
  // sweep makes a tenth.
  for (const double ratio : {1.0, 4.0}) {
    EXPECT_LE(calls(bends, bends, "central_difference", ratio), 4.0);
    EXPECT_LE(calls(bends, linear, "central_difference", ratio), 3.2);
    EXPECT_LE(calls(bends, linear, "newmark", ratio), 3.4);
  }
  EXPECT_LE(calls(bends, bends, "newmark", 1.0), 4.5);
}

/// Halves that spin together through a full turn: kernels turn with them. Undeformed ones take half
/// as many calls again after a quarter of it.
TEST(TiedCombinations, CallsDoNotGrowAsBodiesTurn) {
  for (const char* scheme : {"central_difference: {step: 0.005}", "newmark: {step: 0.01}"}) {
    const auto calls = [scheme](double end) {
      const auto half = [scheme](const std::string& name, double at, int cells,
                                 const std::string& side) {
        return SolidText{
            .name = name,
            .material = "neo_hookean: {youngs_modulus: 100.0, poissons_ratio: 0.25, density: 1.0}",
            .integrator = scheme,
            .position = {at, -0.25},
            .field = "\"-y\", \"x\"",
            .sides = {side},
            .block = {{1.0, 0.5}, {2 * cells, cells}}};
      };
      const auto result = run_solids(end, scheme[0] == 'c' ? 0.05 : 0.1,
                                     {half("a", -1.0, 4, "right"), half("b", 0.0, 6, "left")}, tie,
                                     "schwarz: {tolerance: 1.0e-4}\n");
      EXPECT_TRUE(result->completed());
      return result->measure("schwarz.iterations_mean");
    };
    EXPECT_LE(calls(6.4), 1.1 * calls(0.5)) << scheme;
  }
}

/// Bent in space and in the plane, and rings: a divided static body is in the whole one's
/// equilibrium.
TEST(TiedCombinations, DividedStaticBodiesBendAsWholeOnes) {
  for (const Law& law : laws()) {
    for (const char* plane : {"strain", "stress", "axisymmetric", "space"}) {
      SCOPED_TRACE(law.name + " " + plane);
      const bool ring = plane == std::string("axisymmetric"), space = plane == std::string("space");
      const auto piece = [&](const std::string& name, double from, double to, bool held,
                             bool loaded) {
        Bar bar{law, plane, "quasi_static: {step: 0.1}"};
        if (ring) {
          bar.more = held ? "    constraints: {in: {on: left, x: 0}, floor: {on: bottom, y: 0}}\n"
                          : "    constraints: {floor: {on: bottom, y: 0}}\n";
        } else if (held) {
          bar.more = "    constraints: {clamp: {on: left, fixed: true}}\n";
        }
        if (loaded)
          bar.more += fmt::format("    loads: {{p: {{on: right, traction: [{}]}}}}\n",
                                  ring    ? "\"0.005*t\", 0"
                                  : space ? "0, \"-4.0e-4*t\", \"2.0e-4*t\""
                                          : "0, \"-4.0e-4*t\"");
        SolidText text = bar.piece(name, from, to, {});
        if (held != loaded) text.sides = {held ? "right" : "left"};
        text.field = "";
        return text;
      };
      const auto one = run_solids(1.0, 0.1, {piece("a", 0.0, 2.0, true, true)});
      const auto two = run_solids(
          1.0, 0.1, {piece("a", 0.0, 1.0, true, false), piece("b", 1.0, 2.0, false, true)}, tie,
          sharp);
      ASSERT_TRUE(two->completed());
      const double stored = one->measure("body.a.energy.stored");
      EXPECT_GT(stored, 0.0);
      // The square of the tolerance would do for energies; sums are over ten steps.
      EXPECT_NEAR(two->measure("body.a.energy.stored") + two->measure("body.b.energy.stored"),
                  stored, 1.0e-8 * stored);
    }
  }
}

}  // namespace
}  // namespace abut::tied_combinations_tests
