// Goal: surfaces touch in two and three dimensions, whatever their elements, laws, integrators,
// steps and windows are, and leave nothing behind but what they discretise. Oracles: balance of
// momentum; energy; equal bodies that meet head-on exchange their velocities; a constant pressure
// passes as it is; a linear partner's port kernel predicts its motion, so that one sweep is enough.

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut {
namespace {

struct Block {
  std::string element = "quad4", law = "linear_elastic", integrator;
  int across = 2;
};

struct Impact {
  std::string name;
  int dim = 2;
  Block left, right;
  double window = 0.025;
  double end = 3.0;
};

void PrintTo(const Impact& impact, std::ostream* out) { *out << impact.name; }

constexpr int along = 8;
constexpr double speed = 0.01;  // of that of sound

std::string block(const std::string& name, const Block& b, int dim, double place, double v,
                  const std::string& side) {
  const std::string mesh =
      dim == 2
          ? fmt::format("rectangle: {{lengths: [1.0, 0.25], elements: [{}, {}], element: {}}}",
                        along, b.across, b.element)
          : fmt::format("box: {{lengths: [1.0, 0.25, 0.25], elements: [{}, {}, {}], element: {}}}",
                        along, b.across, b.across, b.element);
  const std::string zeros = dim == 2 ? "0.0" : "0.0, 0.0";
  return fmt::format(
      "  {}:\n"
      "    model: {{fe: {{dimension: {}, mesh: {{{}}}}}}}\n"
      "    material: {{{}: {{youngs_modulus: 1.0, poissons_ratio: 0.0, density: 1.0}}}}\n"
      "    integrator: {{{}}}\n"
      "    initial: {{position: [{}, {}], velocity: [{}, {}]}}\n"
      "    ports: {{face: {{side: {}}}}}\n",
      name, dim, mesh, b.law, b.integrator, number(place), zeros, number(v), zeros, side);
}

std::string text(const Impact& impact) {
  return fmt::format("meta: {{title: test}}\ntime: {{begin: 0.0, end: {}, window: {}}}\nbodies:\n",
                     number(impact.end), number(impact.window)) +
         block("left", impact.left, impact.dim, -1.0, speed, "right") +
         block("right", impact.right, impact.dim, 0.002, -speed, "left") +
         "interfaces: {impact: {sides: [left.face, right.face], contact: {}}}\n";
}

std::unique_ptr<RunResult> run(const Impact& impact) {
  return run_document(Document::from_text("test", text(impact)));
}

bool is_explicit(const Block& b) { return b.integrator.starts_with("central"); }
bool has_lag(const Block& b) { return b.integrator.find("alpha") != std::string::npos; }
bool is_linear(const Block& b) { return b.law == "linear_elastic"; }

std::string scheme(const std::string& name, double step) {
  return fmt::format("{}: {{step: {}}}", name, number(step));
}

/// All pairs of elements with one scheme, all pairs of schemes with one element, all laws.
std::vector<Impact> impacts() {
  const std::vector<std::string> schemes = {"central_difference", "newmark", "hht_alpha",
                                            "generalized_alpha"};
  const std::vector<std::string> laws = {"linear_elastic", "neo_hookean", "hencky",
                                         "saint_venant_kirchhoff"};
  const std::vector<std::string> flat = {"quad4", "tri3", "quad8", "tri6"};
  const std::vector<std::string> solid = {"hex8", "tet4", "hex20", "tet10"};
  constexpr double step = 0.0125;
  std::vector<Impact> out;
  const auto add = [&out](int dim, const Block& left, const Block& right) {
    Impact impact{fmt::format("{}d_{}_{}_{}_on_{}_{}_{}", dim, left.element, left.law,
                              left.integrator.substr(0, left.integrator.find(':')), right.element,
                              right.law, right.integrator.substr(0, right.integrator.find(':'))),
                  dim, left, right};
    const bool new_one = std::ranges::none_of(
        out, [&impact](const Impact& other) { return other.name == impact.name; });
    if (new_one) out.push_back(impact);
  };
  for (const std::string& a : schemes)
    for (const std::string& b : schemes)
      for (const std::string& law : {laws[0], laws[1]})
        add(2, {"quad4", law, scheme(a, step), 2}, {"quad4", law, scheme(b, step), 3});
  for (const std::string& a : flat)
    for (const std::string& b : flat)
      add(2, {a, laws[0], scheme(schemes[0], step / 2), 2},
          {b, laws[0], scheme(schemes[1], step / 2), 3});
  for (const std::string& a : solid)
    for (const std::string& b : {solid[0], solid[1]})
      add(3, {a, laws[0], scheme(schemes[1], step), 1},
          {b, laws[0], scheme(schemes[0], step / 2), 2});
  for (const std::string& a : laws)
    add(3, {"hex8", a, scheme(schemes[0], step), 1},
        {"tet4", laws[1], scheme(schemes[1], step), 2});
  return out;
}

class SurfaceImpact : public testing::TestWithParam<Impact> {};
INSTANTIATE_TEST_SUITE_P(Pairs, SurfaceImpact, testing::ValuesIn(impacts()),
                         [](const auto& c) { return c.param.name; });

TEST_P(SurfaceImpact, ExchangesVelocities) {
  const Impact& impact = GetParam();
  const std::unique_ptr<RunResult> result = run(impact);
  ASSERT_TRUE(result->completed());
  const bool both_explicit = is_explicit(impact.left) && is_explicit(impact.right);
  // Newton's method leaves 1e-9 of the forces, which 240 windows add up. Solids tell the momentum
  // of alpha schemes without their lag [M.24]: while forces change, unlike ones differ by it.
  const bool alpha = has_lag(impact.left) || has_lag(impact.right);
  EXPECT_LE(result->momentum_error(), alpha ? 1.0e-4 : both_explicit ? 1.0e-12 : 1.0e-9);
  // Eight elements disperse the front: 0.5 % measured, of HHT's damping 2 %.
  EXPECT_NEAR(result->energy_error(), 0.0, 0.03);
  EXPECT_NEAR(result->velocity(0), -speed, 0.07 * speed);
  EXPECT_NEAR(result->velocity(1), speed, 0.07 * speed);
  EXPECT_EQ(result->times(RunEvent::Kind::contact_closed, "impact").size(), 1u);
  EXPECT_EQ(result->times(RunEvent::Kind::contact_opened, "impact").size(), 1u);
  const double most = result->measure("schwarz.iterations_max");
  const bool predicted = is_linear(impact.left) || is_linear(impact.right);
  EXPECT_LE(most, predicted ? 1 : 4);
}

/// Steps and windows of linear bodies: one sweep always.
TEST(SurfaceSteps, OneSweepWhateverStepsAndWindowsAre) {
  for (const auto& [k, n] : std::vector<std::pair<std::string, std::string>>{
           {"central_difference", "central_difference"},
           {"central_difference", "newmark"},
           {"newmark", "newmark"},
           {"newmark", "generalized_alpha"}}) {
    for (const auto& [a, b] :
         std::vector<std::pair<double, double>>{{1, 1}, {1, 3}, {3, 1}, {2, 3}, {1, 10}, {10, 1}}) {
      for (const int windows : {1, 4}) {
        constexpr double unit = 0.005;
        const double common = unit * (a * b == 6 ? 6 : std::max(a, b));
        Impact impact{"",
                      2,
                      {"quad4", "linear_elastic", scheme(k, unit * a), 2},
                      {"quad4", "linear_elastic", scheme(n, unit * b), 3}};
        impact.window = windows * common;
        impact.end = std::ceil(2.6 / impact.window) * impact.window;
        const std::unique_ptr<RunResult> result = run(impact);
        const std::string what = fmt::format("{} {} on {} {}, {} windows", k, a, n, b, windows);
        ASSERT_TRUE(result->completed()) << what;
        EXPECT_EQ(result->measure("schwarz.iterations_max"), 1.0) << what;
        // Of alpha schemes without their lag, as above.
        EXPECT_LE(result->momentum_error(), n == "generalized_alpha" ? 1.0e-4 : 1.0e-9) << what;
        EXPECT_NEAR(result->velocity(0), -speed, 0.06 * speed) << what;
        // Touch and release inside a long step cost up to c dt/L of the energy each.
        EXPECT_NEAR(result->energy_error(), 0.0, 0.005 + 2.0 * unit * std::max(a, b)) << what;
      }
    }
  }
}

/// A block that crosses a plate ten times over in one substep, at any phase of it: the way of the
/// substep is searched, not its end alone.
TEST(SurfaceTunnelling, NothingIsPassedThrough) {
  constexpr double step = 0.1, fast = 0.3, thickness = fast * step / 10.0;
  constexpr int phases = 2000;
  for (int phase = 0; phase < phases; ++phase) {
    const double gap = 1.0e-6 + 2.0 * fast * step * phase / phases;
    const std::string scene = fmt::format(
        "meta: {{title: test}}\ntime: {{begin: 0.0, end: 3.0, window: {0}}}\nbodies:\n"
        "  block:\n"
        "    model: {{fe: {{dimension: 2, mesh: {{rectangle: {{lengths: [1.0, 1.0], elements: [1, "
        "2]}}}}}}}}\n"
        "    material: {{neo_hookean: {{youngs_modulus: 1.0, poissons_ratio: 0.0, density: "
        "1.0}}}}\n"
        "    integrator: {{central_difference: {{step: {0}}}}}\n"
        "    initial: {{position: [0.0, {1}], velocity: [0.0, {2}]}}\n"
        "    ports: {{face: {{side: bottom}}}}\n"
        "  plate:\n"
        "    model: {{rigid_tool: {{dimension: 2, mesh: {{rectangle: {{lengths: [3.0, {3}], "
        "elements: "
        "[1, 1]}}}}}}}}\n"
        "    initial: {{position: [-1.0, {4}]}}\n"
        "    ports: {{face: {{side: boundary}}}}\n"
        "interfaces: {{impact: {{sides: [block.face, plate.face], contact: {{}}}}}}\n",
        number(step), number(gap), number(-fast), number(thickness), number(-thickness));
    const auto result = run_document(Document::from_text("test", scene));
    ASSERT_TRUE(result->completed()) << "gap " << gap;
    ASSERT_GT(result->measure("mean_velocity.block.end_y"), 0.5 * fast) << "gap " << gap;
  }
}

std::string pressed(const std::string& name, int dim, const std::string& element, int facets,
                    bool upper) {
  const std::string mesh =
      dim == 2
          ? fmt::format("rectangle: {{lengths: [1.0, 0.5], elements: [{}, 2], element: {}}}",
                        facets, element)
          : fmt::format("box: {{lengths: [1.0, 1.0, 0.5], elements: [{0}, {0}, 2], element: {1}}}",
                        facets, element);
  const std::string low = dim == 2 ? "bottom" : "back", high = dim == 2 ? "top" : "front";
  const char* axis = dim == 2 ? "y" : "z";
  const std::string more = dim == 3 ? ", floor: {on: bottom, y: '0'}" : "";
  return fmt::format(
      "  {}:\n"
      "    model: {{fe: {{dimension: {}, mesh: {{{}}}}}}}\n"
      "    material: {{linear_elastic: {{youngs_modulus: 1.0, poissons_ratio: 0.3, density: "
      "1.0}}}}\n"
      "    integrator: {{quasi_static: {{step: 1.0}}}}\n"
      "    initial: {{position: [{}]}}\n"
      "    ports: {{face: {{side: {}}}}}\n"
      "    constraints: {{end: {{on: {}, {}: '{}'}}, side: {{on: left, x: '0'}}{}}}\n",
      name, dim, mesh, std::string(dim == 2 ? "0.0, " : "0.0, 0.0, ") + (upper ? "0.5" : "0.0"),
      upper ? low : high, upper ? high : low, axis, upper ? "-1e-4 * t" : "0", more);
}

/// Every pair of linear elements, finer on coarser and the other way round.
TEST(SurfacePatch, PassesAConstantPressure) {
  for (const int dim : {2, 3}) {
    const std::vector<std::string> elements = dim == 2 ? std::vector<std::string>{"quad4", "tri3"}
                                                       : std::vector<std::string>{"hex8", "tet4"};
    for (const std::string& a : elements) {
      for (const std::string& b : elements) {
        for (const auto& [k, n] : {std::pair(3, 2), std::pair(2, 3)}) {
          const std::string scene =
              "meta: {title: test}\ntime: {begin: 0.0, end: 1.0, window: 1.0}\nbodies:\n" +
              pressed("upper", dim, a, k, true) + pressed("lower", dim, b, n, false) +
              "interfaces: {joint: {sides: [upper.face, lower.face], contact: {}}}\n";
          const auto result = run_document(Document::from_text("test", scene));
          const std::string what = fmt::format("{} {} on {} {}", a, k, b, n);
          ASSERT_TRUE(result->completed()) << what;
          EXPECT_EQ(result->measure("schwarz.iterations_max"), 1.0) << what;
          const double exact = dim == 2 ? -1.0e-4 / 0.91 : -1.0e-4;  // plane strain; uniaxial
          for (const char* body : {"upper", "lower"}) {
            for (const char* end : {"min", "max"}) {
              const std::string measure =
                  fmt::format("body.{}.nodal_stress.{}.{}", body, dim == 2 ? "yy" : "zz", end);
              // Newton's tolerance of 1e-9 of the forces; 3e-11 measured.
              EXPECT_NEAR(result->measure(measure), exact, 1.0e-9 * std::abs(exact)) << what;
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace abut
