// Goal: joined bodies without inertia are in equilibrium as one body would be, whatever holds each
// of them. Oracles: closed forms, the undivided body, balance of forces, uniform stress.

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::tied_statics_tests {
namespace {

/// Two calls of all bodies: one tells what is missing, the next is exact.
constexpr double two_calls = 2.0;

std::string linear(double modulus, double poissons_ratio) {
  return fmt::format("linear_elastic: {{youngs_modulus: {}, poissons_ratio: {}, density: 1.0}}",
                     number(modulus), number(poissons_ratio));
}

/// A cube or square of side 1.
SolidText piece(const std::vector<int>& cells = {4, 4}, const std::string& law = linear(1.0, 0.3)) {
  return {.material = law,
          .integrator = "quasi_static: {step: 0.25}",
          .sides = {"left", "right"},
          .block = {std::vector<double>(cells.size(), 1.0), cells}};
}

const std::string clamp = "    constraints: {clamp: {on: left, fixed: true}}\n";

/// Pieces in a row, tied, over 4 windows (or as many as `windows`) to time 1.
ResultPtr row(std::vector<SolidText> pieces, int windows = 4, double tolerance = 1.0e-6) {
  std::string ties;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    pieces[k].name = fmt::format("b{}", k);
    pieces[k].position = {static_cast<double>(k)};
    if (k > 0)
      ties += joined(fmt::format("t{}", k), fmt::format("b{}.right", k - 1),
                     fmt::format("b{}.left", k));
  }
  return run_solids(1.0, 1.0 / windows, pieces, ties,
                    fmt::format("schwarz: {{tolerance: {}}}\n", number(tolerance)));
}

/// Of displacements and forces of a row: round-off of a body's factors, 1e-14, times how much
/// softer its neighbours are.
double rounding(double contrast, int count) { return 1.0e-14 * contrast * count + 1.0e-12; }

std::string pull(const std::string& x, const std::string& y) {
  return fmt::format("    loads: {{pull: {{on: right, traction: [\"{}\", \"{}\"]}}}}\n", x, y);
}

/// Stretched by a load at the end, without Poisson's effect: every piece by its own compliance.
TEST(TiedStatics, FloatingRowsOfAnyContrastTakeTwoCalls) {
  for (const int count : {2, 4, 8}) {
    for (const std::vector<double>& moduli :
         {std::vector<double>{1.0, 1.0}, {1.0, 1.0e3}, {1.0e3, 1.0}, {1.0e-6, 1.0}}) {
      SCOPED_TRACE(fmt::format("{} {}", count, fmt::join(moduli, ":")));
      std::vector<SolidText> pieces;
      double stretch = 0.0;
      for (std::size_t k = 0; k < index(count); ++k) {
        const int cells = k % 2 == 1 ? 3 : 4;
        pieces.push_back(piece({cells, cells}, linear(moduli[k % 2], 0.0)));
        stretch += 1.0e-8 / moduli[k % 2];
      }
      pieces.front().more = clamp;
      pieces.back().more = pull("1.0e-8*t", "0");
      const auto result = row(pieces);
      ASSERT_TRUE(result->completed());
      EXPECT_EQ(result->measure("schwarz.iterations_max"), two_calls);
      const std::string end = fmt::format("body.b{}.right.displacement.", count - 1);
      const double contrast = std::max(moduli[0] / moduli[1], moduli[1] / moduli[0]);
      const double left = rounding(contrast, count), force = 1.0e-8;
      EXPECT_NEAR(result->measure(end + "x"), stretch, left * stretch);
      EXPECT_NEAR(result->measure("body.b0.clamp.reaction.x"), -force, left * force);
    }
  }
}

/// Bent and stretched: nodes on nodes, as one body. Small and large strains, plastic ones too.
TEST(TiedStatics, CutBodyIsAsTheWholeOne) {
  struct Case {
    std::string law, keys, x, y;
    double tolerance, most_calls;
  };
  const std::string hyper = ": {youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0}";
  const std::vector<Case> cases = {
      {linear(1.0, 0.3), "", "1.0e-4*t", "-1.0e-5*t", 1.0e-11, two_calls},
      // Displacements to 1e-6 of a step's by the iteration; turns of up to a radian.
      {"neo_hookean" + hyper, "", "0", "-1.0e-3*t", 1.0e-6, 6.0},
      {"saint_venant_kirchhoff" + hyper, "", "0", "-1.0e-3*t", 1.0e-6, 6.0},
      {"j2_plasticity: {youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0, yield_stress: "
       "1.0e-3, hardening: 0.1}",
       "formulation: mean_dilatation, ", "1.224e-3*t", "-2.0e-5*t", 1.0e-6, 8.0}};
  for (const Case& c : cases) {
    for (const int count : {2, 4}) {
      SCOPED_TRACE(fmt::format("{} {}", c.law, count));
      SolidText part = piece({4, 4}, c.law);
      part.keys = c.keys;
      std::vector<SolidText> pieces(index(count), part);
      pieces.front().more += clamp;
      pieces.back().more += pull(c.x, c.y);
      const auto divided = row(pieces);
      ASSERT_TRUE(divided->completed());
      EXPECT_LE(divided->measure("schwarz.iterations_max"), c.most_calls);
      part.name = "whole";
      part.block.lengths[0] = 1.0 * count;
      part.block.cells[0] = 4 * count;
      part.more = clamp + pull(c.x, c.y);
      const auto whole = run_solids(1.0, 0.25, {part});
      const double size = std::abs(whole->measure("body.whole.right.displacement.y"));
      for (const char* i : {"x", "y"}) {
        EXPECT_NEAR(divided->measure(fmt::format("body.b{}.right.displacement.{}", count - 1, i)),
                    whole->measure(fmt::format("body.whole.right.displacement.{}", i)),
                    c.tolerance * size)
            << i;
      }
    }
  }
}

/// Uniform stress passes joints of any meshes; the one body keeps a motion, the other one all.
TEST(TiedStatics, UniformStressPasses) {
  const auto check = [](SolidText left, SolidText right, const char* cell) {
    const std::size_t dim = left.block.cells.size();
    SCOPED_TRACE(fmt::format("{}d {} {}", dim, cell, fmt::join(right.block.cells, "x")));
    right.block.element = cell;
    left.more = dim == 2 ? "    constraints: {end: {on: left, x: 0}, floor: {on: bottom, y: 0}}\n"
                         : "    constraints: {end: {on: left, x: 0}, floor: {on: bottom, y: 0}, "
                           "back: {on: back, z: 0}}\n";
    right.more = dim == 2
                     ? pull("0.01*t", "0")
                     : "    loads: {pull: {on: right, traction: [\"0.01*t\", \"0\", \"0\"]}}\n";
    const auto result = row({left, right});
    ASSERT_TRUE(result->completed());
    EXPECT_EQ(result->measure("schwarz.iterations_max"), two_calls);
    for (const char* body : {"b0", "b1"})
      for (const char* end : {"min", "max"})
        // 1 % of a modulus of one: 1e-10 of it
        EXPECT_NEAR(result->measure(fmt::format("body.{}.nodal_stress.xx.{}", body, end)), 0.01,
                    1.0e-12);
  };
  for (const std::vector<int>& cells : {std::vector<int>{3, 3}, {2, 2}, {5, 5}})
    for (const char* cell : {"quad4", "tri3"}) check(piece({3, 3}), piece(cells), cell);
  for (const char* cell : {"hex8", "tet4"}) check(piece({2, 2, 2}), piece({3, 3, 3}), cell);
}

/// Rings are carried along their axis alone.
TEST(TiedStatics, RingsFloatToo) {
  std::vector<SolidText> rings;
  for (const int k : {0, 1}) {
    SolidText ring = piece({4 - k, 4}, linear(k == 0 ? 1.0 : 10.0, 0.0));
    ring.name = fmt::format("b{}", k);
    ring.keys = "plane: axisymmetric, ";
    ring.position = {1.0, 1.0 * k};
    ring.sides = {"bottom", "top"};
    ring.more = k == 0 ? "    constraints: {floor: {on: bottom, y: 0}}\n"
                       : "    loads: {pull: {on: top, traction: [\"0\", \"0.01*t\"]}}\n";
    rings.push_back(ring);
  }
  const auto result = run_solids(1.0, 0.25, rings, joined("t", "b0.top", "b1.bottom"));
  ASSERT_TRUE(result->completed());
  EXPECT_EQ(result->measure("schwarz.iterations_max"), two_calls);
  EXPECT_NEAR(result->measure("body.b1.top.displacement.y"), 0.011, rounding(10.0, 2) * 0.011);
}

/// Where the material yields, bodies are asked after every sweep how they give way now.
TEST(TiedStatics, PlasticBodiesTakeFewCalls) {
  const auto law = [](double yield) {
    return fmt::format(
        "j2_plasticity: {{youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0, "
        "yield_stress: {}, hardening: 0.1}}",
        number(yield));
  };
  for (const auto& [first, second] :
       {std::pair(1.0e-3, 1.0), std::pair(1.0, 1.0e-3), std::pair(1.0e-3, 1.0e-3)}) {
    SCOPED_TRACE(fmt::format("{} {}", first, second));
    SolidText held = piece({4, 3}, law(first));
    held.more = clamp;
    held.keys = "formulation: mean_dilatation, ";
    held.integrator = fmt::format("quasi_static: {{step: {}}}", number(1.0 / 6.0));
    SolidText loaded = held;
    loaded.block.cells = {5, 4};
    loaded.material = law(second);
    loaded.more = pull("1.224e-3*t", "-2.0e-5*t");
    const auto result = row({held, loaded}, 6, 1.0e-5);
    ASSERT_TRUE(result->completed());
    EXPECT_GT(
        result->measure("body.b0.energy.dissipated") + result->measure("body.b1.energy.dissipated"),
        0.0);
    EXPECT_LE(result->measure("schwarz.iterations_mean"), 3.0);  // the method's goal
  }
}

/// A body without inertia that only one with inertia holds goes where that goes.
TEST(TiedStatics, BodiesWithInertiaHoldThem) {
  SolidText moved = piece({4, 4}, linear(1.0, 0.0));  // without Poisson's effect: a straight face
  moved.integrator = "newmark: {step: 0.05}";
  moved.more = "    constraints: {clamp: {on: left, x: \"0.1*sin(t)\", y: 0}}\n";
  SolidText carried = piece({3, 3}, linear(1.0, 0.0));
  carried.integrator = "quasi_static: {step: 0.05}";
  const auto result = row({moved, carried}, 20);
  ASSERT_TRUE(result->completed());
  EXPECT_LE(result->measure("schwarz.iterations_max"), two_calls);
  // Without forces on it, it is carried without strain.
  EXPECT_NEAR(result->measure("body.b1.energy.stored"), 0.0, 1.0e-15);
  EXPECT_NEAR(result->measure("body.b1.right.displacement.x"),
              result->measure("body.b0.right.displacement.x"), roundoff(100.0, 0.1));
}

TEST(TiedStatics, NetThatNothingHoldsIsRefused) {
  const auto message = [](const std::vector<SolidText>& pieces) {
    return refusal([&pieces] { row(pieces); });
  };
  const SolidText floats = piece();
  SolidText held = floats, slides = floats;
  held.more = clamp;
  slides.more = "    constraints: {end: {on: bottom, y: 0}}\n";
  EXPECT_NE(message({floats, floats}).find("'b0', 'b1'"), std::string::npos);
  EXPECT_NE(message({slides, floats}).find("free to move or turn"), std::string::npos);
  EXPECT_EQ(message({held, floats, floats}), "not refused");
}

}  // namespace
}  // namespace abut::tied_statics_tests
