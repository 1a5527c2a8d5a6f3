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
#include "tests/support/solid_scenes.hpp"

namespace abut {
namespace {

/// Two calls of all bodies: one tells what is missing, the next is exact.
constexpr double two_calls = 2.0;

struct Piece {
  std::vector<int> cells = {4, 4};
  std::string law = "linear_elastic: {youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0}";
  std::string cell = {}, keys = {};
  std::string integrator = "quasi_static: {step: 0.25}";
  std::string more = {};
};

std::string linear(double modulus, double poissons_ratio) {
  return fmt::format("linear_elastic: {{youngs_modulus: {}, poissons_ratio: {}, density: 1.0}}",
                     number(modulus), number(poissons_ratio));
}

const std::string clamp = "    constraints: {clamp: {on: left, fixed: true}}\n";

/// Cubes or squares of side 1 in a row, tied, over 4 windows (or as many as `windows`) to time 1.
std::unique_ptr<RunResult> row(const std::vector<Piece>& pieces, int dim = 2, int windows = 4,
                               double tolerance = 1.0e-6) {
  std::string text = fmt::format(
      "meta: {{title: test}}\ntime: {{begin: 0.0, end: 1.0, window: {}}}\n"
      "schwarz: {{tolerance: {}}}\nbodies:\n",
      number(1.0 / windows), number(tolerance));
  std::string ties = "interfaces:\n";
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const Piece& p = pieces[k];
    const std::vector<double> lengths(index(dim), 1.0);
    text += fmt::format(
        "  b{}:\n    model: {{fe: {{dimension: {}, {}mesh: {{{}}}}}}}\n    material: {{{}}}\n"
        "    integrator: {{{}}}\n    initial: {{position: {}}}\n"
        "    ports: {{left: {{side: left}}, right: {{side: right}}}}\n{}",
        k, dim, p.keys, block_mesh(lengths, p.cells, p.cell), p.law, p.integrator,
        components({static_cast<double>(k)}, dim), p.more);
    if (k > 0)
      ties += fmt::format("  t{0}: {{sides: [b{1}.right, b{0}.left], tied: {{}}}}\n", k, k - 1);
  }
  return run_document(Document::from_text("test", text + (pieces.size() > 1 ? ties : "")));
}

std::string pull(const std::string& x, const std::string& y) {
  return fmt::format("    loads: {{pull: {{on: right, traction: [\"{}\", \"{}\"]}}}}\n", x, y);
}

/// Stretched by a load at the end, without Poisson's effect: every piece by its own compliance.
TEST(TiedStatics, FloatingRowsOfAnyContrastTakeTwoCalls) {
  for (const int count : {2, 4, 8}) {
    for (const std::vector<double>& moduli :
         {std::vector<double>{1.0, 1.0}, {1.0, 1.0e3}, {1.0e3, 1.0}, {1.0e-6, 1.0}}) {
      SCOPED_TRACE(fmt::format("{} {}", count, fmt::join(moduli, ":")));
      std::vector<Piece> pieces(index(count));
      double stretch = 0.0;
      for (std::size_t k = 0; k < pieces.size(); ++k) {
        if (k % 2 == 1) pieces[k].cells = {3, 3};
        pieces[k].law = linear(moduli[k % 2], 0.0);
        stretch += 1.0e-8 / moduli[k % 2];
      }
      pieces.front().more = clamp;
      pieces.back().more = pull("1.0e-8*t", "0");
      const auto result = row(pieces);
      ASSERT_TRUE(result->completed());
      EXPECT_EQ(result->measure("schwarz.iterations_max"), two_calls);
      const std::string end = fmt::format("body.b{}.right.displacement.", count - 1);
      // Round-off of a body's factors, 1e-14, times how much softer its neighbours are.
      const double contrast = std::max(moduli[0] / moduli[1], moduli[1] / moduli[0]);
      const double rounding = 1.0e-14 * contrast * count + 1.0e-12;
      EXPECT_NEAR(result->measure(end + "x"), stretch, rounding * stretch);
      EXPECT_NEAR(result->measure("body.b0.clamp.reaction.x"), -1.0e-8, rounding * 1.0e-8);
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
      std::vector<Piece> pieces(index(count), Piece{.law = c.law, .keys = c.keys});
      pieces.front().more += clamp;
      pieces.back().more += pull(c.x, c.y);
      const auto divided = row(pieces);
      ASSERT_TRUE(divided->completed());
      EXPECT_LE(divided->measure("schwarz.iterations_max"), c.most_calls);
      const auto whole = run_document(Document::from_text(
          "test",
          fmt::format("meta: {{title: test}}\ntime: {{begin: 0.0, end: 1.0, window: 0.25}}\n"
                      "bodies:\n  whole:\n    model: {{fe: {{dimension: 2, {}mesh: {{{}}}}}}}\n"
                      "    material: {{{}}}\n    integrator: {{quasi_static: {{step: 0.25}}}}\n"
                      "    ports: {{right: {{side: right}}}}\n{}{}",
                      c.keys, block_mesh({1.0 * count, 1.0}, {4 * count, 4}), c.law, clamp,
                      pull(c.x, c.y))));
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
  const auto check = [](int dim, const Piece& first, const Piece& second) {
    SCOPED_TRACE(fmt::format("{}d {} {}", dim, second.cell, fmt::join(second.cells, "x")));
    Piece left = first, right = second;
    left.more = dim == 2 ? "    constraints: {end: {on: left, x: 0}, floor: {on: bottom, y: 0}}\n"
                         : "    constraints: {end: {on: left, x: 0}, floor: {on: bottom, y: 0}, "
                           "back: {on: back, z: 0}}\n";
    right.more = dim == 2
                     ? pull("0.01*t", "0")
                     : "    loads: {pull: {on: right, traction: [\"0.01*t\", \"0\", \"0\"]}}\n";
    const auto result = row({left, right}, dim);
    ASSERT_TRUE(result->completed());
    EXPECT_EQ(result->measure("schwarz.iterations_max"), two_calls);
    for (const char* body : {"b0", "b1"})
      for (const char* end : {"min", "max"})
        EXPECT_NEAR(result->measure(fmt::format("body.{}.nodal_stress.xx.{}", body, end)), 0.01,
                    1.0e-12);
  };
  for (const std::vector<int>& cells : {std::vector<int>{3, 3}, {2, 2}, {5, 5}})
    for (const char* cell : {"quad4", "tri3"})
      check(2, {.cells = {3, 3}}, {.cells = cells, .cell = cell});
  for (const char* cell : {"hex8", "tet4"})
    check(3, {.cells = {2, 2, 2}}, {.cells = {3, 3, 3}, .cell = cell});
}

/// Rings are carried along their axis alone.
TEST(TiedStatics, RingsFloatToo) {
  std::vector<Piece> rings(2, Piece{.keys = "plane: axisymmetric, "});
  std::string text = "meta: {title: test}\ntime: {begin: 0.0, end: 1.0, window: 0.25}\nbodies:\n";
  for (const int k : {0, 1})
    text += fmt::format(
        "  b{}:\n    model: {{fe: {{dimension: 2, plane: axisymmetric, mesh: {{{}}}}}}}\n"
        "    material: {{{}}}\n    integrator: {{quasi_static: {{step: 0.25}}}}\n"
        "    initial: {{position: [1.0, {}]}}\n    ports: {{low: {{side: bottom}}, high: {{side: "
        "top}}}}\n{}",
        k, block_mesh({1.0, 1.0}, {4 - k, 4}), linear(k == 0 ? 1.0 : 10.0, 0.0), k,
        k == 0 ? "    constraints: {floor: {on: bottom, y: 0}}\n"
               : "    loads: {pull: {on: top, traction: [\"0\", \"0.01*t\"]}}\n");
  const auto result = run_document(Document::from_text(
      "test", text + "interfaces: {t: {sides: [b0.high, b1.low], tied: {}}}\n"));
  ASSERT_TRUE(result->completed());
  EXPECT_EQ(result->measure("schwarz.iterations_max"), two_calls);
  EXPECT_NEAR(result->measure("body.b1.high.displacement.y"), 0.01 + 0.001, 1.0e-12);
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
    Piece held{.cells = {4, 3}, .law = law(first), .more = clamp};
    held.keys = "formulation: mean_dilatation, ";
    held.integrator = fmt::format("quasi_static: {{step: {}}}", number(1.0 / 6.0));
    Piece loaded = held;
    loaded.cells = {5, 4};
    loaded.law = law(second);
    loaded.more = pull("1.224e-3*t", "-2.0e-5*t");
    const auto result = row({held, loaded}, 2, 6, 1.0e-5);
    ASSERT_TRUE(result->completed());
    EXPECT_GT(
        result->measure("body.b0.energy.dissipated") + result->measure("body.b1.energy.dissipated"),
        0.0);
    EXPECT_LE(result->measure("schwarz.iterations_mean"), 3.0);  // the method's goal
  }
}

/// A body without inertia that only one with inertia holds goes where that goes.
TEST(TiedStatics, BodiesWithInertiaHoldThem) {
  const auto result =
      row({{.law = linear(1.0, 0.0),  // without Poisson's effect its face stays straight
            .integrator = "newmark: {step: 0.05}",
            .more = "    constraints: {clamp: {on: left, x: \"0.1*sin(t)\", y: 0}}\n"},
           {.cells = {3, 3}, .law = linear(1.0, 0.0), .integrator = "quasi_static: {step: 0.05}"}},
          2, 20);
  ASSERT_TRUE(result->completed());
  EXPECT_LE(result->measure("schwarz.iterations_max"), two_calls);
  // Without forces on it, it is carried without strain.
  EXPECT_NEAR(result->measure("body.b1.energy.stored"), 0.0, 1.0e-15);
  EXPECT_NEAR(result->measure("body.b1.right.displacement.x"),
              result->measure("body.b0.right.displacement.x"), 1.0e-10);
}

TEST(TiedStatics, NetThatNothingHoldsIsRefused) {
  const auto message = [](const std::vector<Piece>& pieces) -> std::string {
    try {
      row(pieces);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const Piece floats{}, held{.more = clamp},
      slides{.more = "    constraints: {end: {on: bottom, y: 0}}\n"};
  EXPECT_NE(message({floats, floats}).find("'b0', 'b1'"), std::string::npos);
  EXPECT_NE(message({slides, floats}).find("free to move or turn"), std::string::npos);
  EXPECT_EQ(message({held, floats, floats}), "");
}

}  // namespace
}  // namespace abut
