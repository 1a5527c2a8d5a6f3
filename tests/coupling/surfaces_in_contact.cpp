// Goal: surfaces touch in two and three dimensions, whatever their elements, laws, integrators,
// steps and windows are, and leave nothing behind but what they discretise. Oracles: balance of
// momentum; energy; equal bodies that meet head-on exchange their velocities; a constant pressure
// passes as it is; a linear partner's port kernel predicts its motion, so that one sweep is enough.

#include <algorithm>
#include <ostream>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::surfaces_in_contact_tests {
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

constexpr double speed = 0.01;  // of that of sound

SolidText block(const std::string& name, const Block& b, int dim, double place, double v,
                const std::string& side) {
  return {.name = name,
          .dim = dim,
          .mesh = bar_mesh(dim, b.across, b.element),
          .material = unit_law(b.law, 0.0),
          .integrator = b.integrator,
          .position = {place},
          .velocity = {v},
          .side = side};
}

ResultPtr run(const Impact& impact) {
  return run_solids(impact.end, impact.window,
                    {block("left", impact.left, impact.dim, -1.0, speed, "right"),
                     block("right", impact.right, impact.dim, 0.002, -speed, "left")},
                    touching("impact", "left.face", "right.face"));
}

bool is_explicit(const Block& b) { return b.integrator.starts_with("central"); }
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
  const ResultPtr result = run(impact);
  ASSERT_TRUE(result->completed());
  const bool both_explicit = is_explicit(impact.left) && is_explicit(impact.right);
  // Newton's method leaves 1e-9 of the forces, which 240 windows add up.
  EXPECT_LE(result->momentum_error(), both_explicit ? 1.0e-12 : 1.0e-9);
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
        const ResultPtr result = run(impact);
        const std::string what = fmt::format("{} {} on {} {}, {} windows", k, a, n, b, windows);
        ASSERT_TRUE(result->completed()) << what;
        EXPECT_EQ(result->measure("schwarz.iterations_max"), 1.0) << what;
        // Newton's method leaves as much of the forces.
        EXPECT_LE(result->momentum_error(), 1.0e-9) << what;
        EXPECT_NEAR(result->velocity(0), -speed, 0.06 * speed) << what;
        // Touch and release inside a long step cost up to c dt/L of the energy each.
        EXPECT_NEAR(result->energy_error(), 0.0, 0.005 + 2.0 * unit * std::max(a, b)) << what;
      }
    }
  }
}

/// Of a fixed point: dimension, law, integrator.
using Mirrored = std::tuple<int, std::string, std::string>;

class SurfaceFixedPoint : public testing::TestWithParam<Mirrored> {};
INSTANTIATE_TEST_SUITE_P(
    Blocks, SurfaceFixedPoint,
    testing::Combine(testing::Values(2, 3), testing::Values("linear_elastic", "neo_hookean"),
                     testing::Values("central_difference", "newmark", "hht_alpha")),
    [](const auto& c) {
      return fmt::format("{}d_{}_{}", std::get<0>(c.param), std::get<1>(c.param),
                         std::get<2>(c.param));
    });

/// Two equal blocks that meet head-on are one problem, which a wall in the plane between them cuts
/// in half: there nothing is exchanged, and one body solves it all. Of any mesh; in space of 12
/// cells.
TEST_P(SurfaceFixedPoint, IsTheUndividedProblem) {
  constexpr double step = 0.0125;
  const int dim = std::get<0>(GetParam());
  const std::string law = std::get<1>(GetParam()), name = std::get<2>(GetParam());
  const std::string mesh = dim == 2 ? bar_mesh(2, 2) : block_mesh({1.0, 0.25, 0.25}, {3, 2, 2});
  const auto solid = [&](const char* body, double place, double v, const char* side) {
    SolidText text = block(body, {"", law, scheme(name, step)}, dim, place, v, side);
    text.mesh = mesh;
    text.material = unit_law(law, 0.3);
    return text;
  };
  SolidText wall{
      .name = "wall",
      .dim = dim,
      .mesh = dim == 2 ? block_mesh({0.5, 1.0}, {1, 1}) : block_mesh({0.5, 1.0, 1.0}, {1, 1, 1}),
      .position = {0.0, -0.4, -0.4},
      .side = "left",
      .model = "rigid_tool"};
  wall.position.resize(index(dim));
  const SolidText left = solid("left", -1.001, speed, "right");
  for (const double window : {step, 4.0 * step}) {
    SCOPED_TRACE(fmt::format("windows of {} s", window));
    const std::string tight = "schwarz: {tolerance: 1.0e-8}\n";
    const auto one =
        run_solids(2.6, window, {left, wall}, touching("impact", "left.face", "wall.face"));
    const auto two = run_solids(2.6, window, {left, solid("right", 0.001, -speed, "left")},
                                touching("impact", "left.face", "right.face") + tight);
    ASSERT_TRUE(one->completed() && two->completed());
    const double impulse = one->measure("contact.impact.impulse");
    // What sweeps leave open at that tolerance.
    EXPECT_NEAR(two->measure("contact.impact.impulse"), impulse, 1.0e-6 * impulse);
    const double scale = one->masses[0] * speed;
    std::size_t alike = 0, r = 0;
    for (const RunResult::Row& row : one->rows) {  // flights end where they like
      while (r + 1 < two->rows.size() && two->rows[r].time < row.time - 0.5 * step) ++r;
      if (std::abs(two->rows[r].time - row.time) > 1.0e-9) continue;
      ++alike;
      // as much
      ASSERT_NEAR(two->rows[r].momentum[0], row.momentum[0], 1.0e-6 * scale)
          << "at " << row.time << " s";
    }
    EXPECT_GT(static_cast<double>(alike) * window, 1.9);  // contact lasts 2 s
  }
}

/// A block that crosses a plate ten times over in one substep, at any phase of it: the way of the
/// substep is searched, not its end alone.
TEST(SurfaceTunnelling, NothingIsPassedThrough) {
  constexpr double step = 0.1, fast = 0.3, thickness = fast * step / 10.0;
  constexpr int phases = 2000;
  for (int phase = 0; phase < phases; ++phase) {
    const double gap = 1.0e-6 + 2.0 * fast * step * phase / phases;
    const SolidText block{.name = "block",
                          .mesh = block_mesh({1.0, 1.0}, {1, 2}),
                          .material = unit_law("neo_hookean", 0.0),
                          .integrator = scheme("central_difference", step),
                          .position = {0.0, gap},
                          .velocity = {0.0, -fast},
                          .side = "bottom"};
    const SolidText plate{.name = "plate",
                          .mesh = block_mesh({3.0, thickness}, {1, 1}),
                          .position = {-1.0, -thickness},
                          .side = "boundary",
                          .model = "rigid_tool"};
    const auto result =
        run_solids(3.0, step, {block, plate}, touching("impact", "block.face", "plate.face"));
    ASSERT_TRUE(result->completed()) << "gap " << gap;
    ASSERT_GT(result->measure("mean_velocity.block.end_y"), 0.5 * fast) << "gap " << gap;
  }
}

SolidText pressed(const std::string& name, int dim, const std::string& element, int facets,
                  bool upper) {
  const std::string low = dim == 2 ? "bottom" : "back", high = dim == 2 ? "top" : "front";
  const std::vector<double> below(index(dim), 0.0);
  std::vector<double> above = below;
  above.back() = 0.5;
  return {.name = name,
          .dim = dim,
          .mesh = dim == 2 ? block_mesh({1.0, 0.5}, {facets, 2}, element)
                           : block_mesh({1.0, 1.0, 0.5}, {facets, facets, 2}, element),
          .material = unit_law("linear_elastic", 0.3),
          .integrator = scheme("quasi_static", 1.0),
          .position = upper ? above : below,
          .side = upper ? low : high,
          .more = fmt::format(
              "    constraints: {{end: {{on: {}, {}: '{}'}}, side: {{on: left, x: '0'}}{}}}\n",
              upper ? high : low, dim == 2 ? "y" : "z", upper ? "-1e-4 * t" : "0",
              dim == 3 ? ", floor: {on: bottom, y: '0'}" : "")};
}

/// Every pair of linear elements, finer on coarser and the other way round.
TEST(SurfacePatch, PassesAConstantPressure) {
  for (const int dim : {2, 3}) {
    const std::vector<std::string> elements = dim == 2 ? std::vector<std::string>{"quad4", "tri3"}
                                                       : std::vector<std::string>{"hex8", "tet4"};
    for (const std::string& a : elements) {
      for (const std::string& b : elements) {
        for (const auto& [k, n] : {std::pair(3, 2), std::pair(2, 3)}) {
          const auto result = run_solids(
              1.0, 1.0, {pressed("upper", dim, a, k, true), pressed("lower", dim, b, n, false)},
              touching("joint", "upper.face", "lower.face"));
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
}  // namespace abut::surfaces_in_contact_tests
