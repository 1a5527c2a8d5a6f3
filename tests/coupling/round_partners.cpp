// Goal: facets that are long beside the radius of what they touch neither press it before they
// touch, nor let it in. Oracles: a beam on three rollers in closed form (Timoshenko), whatever its
// facets; what falls on a roller touches it when it is there.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut {
namespace {

constexpr double radius = 0.01;

SolidText roller(const std::string& name, double x, double y, const std::string& way = "") {
  return {.name = name,
          .mesh = fmt::format("disk: {{radius: {}, core: 8, layers: 2}}", radius),
          .position = {x, y},
          .side = "boundary",
          .model = "rigid_tool",
          .keys = way.empty() ? "" : "way: [\"0\", \"" + way + "\"], "};
}

struct Beam {
  int cells;
  const char* element;
  double allowed;  // of the force: the mesh's own stiffness under three single forces
};

class RoundPartners : public testing::TestWithParam<Beam> {};

/// Facets of 1/4 to 2 radii. Averages of dual functions pressed by h^2/12R more than the punch
/// went: up to eight times the force.
TEST_P(RoundPartners, BendABeamOfAnyFacets) {
  constexpr double span = 0.2, height = 0.01, thickness = 0.02, modulus = 2.0e9, way = 2.0e-4;
  const SolidText beam{
      .name = "beam",
      .material = fmt::format(
          "linear_elastic: {{youngs_modulus: {}, poissons_ratio: 0.3, density: 1200.0}}", modulus),
      .integrator = "quasi_static: {step: 0.5}",
      .position = {-0.12, 0.0},
      .side = "boundary",
      .keys = "plane: stress, thickness: 0.02, ",
      .more = "    points: {mid: {at: [0.0, 0.0]}}\n    constraints: {mid: {on: mid, x: \"0\"}}\n",
      .block = block_in(2, {0.24, height}, {GetParam().cells, 2}, GetParam().element)};
  const ResultPtr run = run_scene(
      1.0, 0.5,
      texts_of({beam, roller("left", -0.5 * span, -radius), roller("right", 0.5 * span, -radius),
                roller("punch", 0.0, height + radius, fmt::format("-{} * t", way))}),
      "contact: {everything: {}}\n");
  ASSERT_TRUE(run->completed()) << run->end.reason;
  const double inertia = thickness * std::pow(height, 3) / 12.0, shear = modulus / 2.6 * 5.0 / 6.0;
  const double bending = std::pow(span, 3) / (48.0 * modulus * inertia);
  const double force = way / (bending + span / (4.0 * thickness * height * shear));
  EXPECT_NEAR(run->measure("body.punch.force.y"), force, GetParam().allowed * force);
}

// 5 %: local dents of a node's width under rollers, and half a facet's chord of the rollers.
INSTANTIATE_TEST_SUITE_P(Facets, RoundPartners,
                         testing::Values(Beam{12, "quad8", 0.05}, Beam{24, "quad8", 0.05},
                                         Beam{48, "quad8", 0.05}, Beam{12, "quad9", 0.05},
                                         Beam{24, "tri6", 0.05}, Beam{30, "quad8", 0.05}));

/// In space the roller is wider than the beam, whose edges lie across it.
TEST(RoundPartner, BendsABeamWhoseEdgesLieOverIt) {
  constexpr double at = 0.09, height = 0.01, width = 0.03, modulus = 2.0e9, way = 1.0e-4;
  const double inertia = width * std::pow(height, 3) / 12.0, shear = modulus / 2.0 * 5.0 / 6.0;
  const double force = way / (std::pow(at, 3) / (3.0 * modulus * inertia) +
                              at / (width * height * shear));
  for (const int cells : {5, 10}) {
    const SolidText beam{
        .name = "beam",
        .material = fmt::format(
            "linear_elastic: {{youngs_modulus: {}, poissons_ratio: 0.0, density: 1200.0}}",
            modulus),
        .integrator = "quasi_static: {step: 0.5}",
        .position = {0.0, -0.5 * width, 0.0},
        .side = "boundary",
        .more = "    constraints: {clamp: {on: left, x: \"0\", y: \"0\", z: \"0\"}}\n",
        .block = block_in(3, {0.1, width, height}, {cells, 2, 1}, "hex20")};
    const SolidText punch{.name = "punch",
                          .dim = 3,
                          .mesh = "cylinder: {radius: 0.01, length: 0.05, core: 4, layers: 2, "
                                  "elements: 2}",
                          .position = {at, 0.025, height + radius},
                          .side = "boundary",
                          .model = "rigid_tool",
                          .keys = fmt::format("map: [x, -z, y], way: [\"0\", \"0\", \"-{} * t\"], ",
                                              way)};
    const ResultPtr run =
        run_scene(1.0, 0.5, texts_of({beam, punch}), "contact: {everything: {}}\n");
    ASSERT_TRUE(run->completed()) << run->end.reason;
    // Ten times as much for five elements before. 2 %: what one element through the height,
    // and the dent of the roller, differ from a beam by.
    EXPECT_NEAR(run->measure("body.punch.force.z"), force, 0.02 * force) << cells;
  }
}

/// Blocks of 2 and 3 cells of half a radius to two: on nodes of the face and between them.
TEST(RoundPartner, IsTouchedWhenItIsThere) {
  constexpr double gap = 0.003, speed = 2.0, step = 2.0e-5;
  for (const double facet : {0.5 * radius, radius, 2.0 * radius}) {
    for (const int cells : {2, 3}) {
      for (const std::string scheme : {"newmark", "central_difference"}) {
        const double width = cells * facet;
        const SolidText block{
            .name = "block",
            .material = "linear_elastic: {youngs_modulus: 5.0e6, poissons_ratio: 0.3, density: "
                        "1000.0}",
            .integrator = fmt::format("{}: {{step: {}}}", scheme, step),
            .position = {-0.5 * width, gap},
            .velocity = {0.0, -speed},
            .side = "bottom",
            .block = block_in(2, {width, width}, {cells, cells})};
        const ResultPtr run =
            run_solids(0.004, step, {block, roller("roller", 0.0, -radius)},
                       "  hit: {sides: [block.face, roller.face], contact: {}}\n");
        ASSERT_TRUE(run->completed()) << run->end.reason;
        const double begin = run->measure("contact.hit.begin");
        // One of 32 nodes of the roller is on top. Two steps: of the window that closes, and of
        // the instant that it is told with.
        EXPECT_NEAR(begin, gap / speed, 2.0 * step) << facet << ' ' << cells << ' ' << scheme;
        // A tenth of what averages lost of such falls.
        EXPECT_LT(run->measure("energy.total.relative_drift_max"), 0.01);
      }
    }
  }
}

}  // namespace
}  // namespace abut
