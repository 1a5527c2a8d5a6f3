// Goal: surfaces start where their bodies are apart, however they lie, and where they touch; bodies
// that are in each other are refused with places and depths, whatever form their contact has.
// Oracles: blocks and arches in given places.

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/refusal.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/solid_texts.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::starts_of_surfaces_tests {
namespace {

SolidText solid(const std::string& name, const std::vector<double>& position) {
  return {
      .name = name,
      .material = "linear_elastic: {youngs_modulus: 1.0e6, poissons_ratio: 0.3, density: 1000.0}",
      .integrator = scheme_named('I', 1.0e-4),
      .position = position,
      .side = "boundary"};
}

/// A block of so many cells; of one across all nodes lie on the surface, and contact is passive.
std::string block_text(const std::string& name, int dim, const std::vector<double>& lengths,
                       int cells, const std::vector<double>& position) {
  SolidText out = solid(name, position);
  out.block = block_in(dim, lengths, {cells, cells, cells});
  return out.text();
}

std::string arch(const std::string& name, double inner, double outer, int cells) {
  SolidText out = solid(name, {});
  out.mesh = fmt::format("rectangle: {{lengths: [1.0, 1.0], elements: [2, {}]}}", cells);
  const std::string radius = fmt::format("({} + {} * x)", inner, outer - inner);
  out.keys = fmt::format("map: [\"{0} * cos({1} * y)\", \"{0} * sin({1} * y)\"], ", radius,
                         std::acos(-1.0));
  return out.text();
}

const std::string met =
    "interfaces: {met: {sides: [one.face, other.face], contact: {friction: 0.2}}}\n";
const std::string everything = "contact: {everything: {friction: 0.2}}\n";

std::string told_of(const std::string& bodies, const std::string& contact) {
  return refusal([&] { run_text(scene_text(2.0e-4, 1.0e-4, bodies, contact)); });
}

struct Blocks {
  const char* name;
  std::vector<double> lengths, position;  // of the second; the first is [0, 1]
  double least, most;                     // [m] depth that is told; 0: they start
};

const std::vector<Blocks>& all_blocks() {
  static const std::vector<Blocks> all{{"on each other", {1, 1, 1}, {0, 1, 0}, 0, 0},
                                       {"shifted", {1, 1, 1}, {0.3, 1, 0.2}, 0, 0},
                                       {"edge on edge", {1, 1, 1}, {1, 1, 0}, 0, 0},
                                       {"corner on corner", {1, 1, 1}, {1, 1, 1}, 0, 0},
                                       {"near", {1, 1, 1}, {0.3, 1.001, 0.2}, 0, 0},
                                       {"overlapping", {1, 1, 1}, {0.3, 0.9, 0.2}, 0.099, 0.101},
                                       {"flush", {1, 1, 1}, {0, 0.9, 0}, 0.09, 0.101},
                                       {"nested", {0.1, 0.1, 0.1}, {0.45, 0.45, 0.45}, 0.4, 0.51},
                                       {"crossing", {0.2, 4, 4}, {0.4, -1.5, -1.5}, 0.09, 0.51}};
  return all;
}

double depth_told(const std::string& text) {
  const std::string before = "overlap by ";
  const std::size_t at = text.find(before);
  return at == std::string::npos ? 0.0 : std::stod(text.substr(at + before.size()));
}

TEST(StartsOfSurfaces, AreRefusedWhereBodiesAreInEachOtherAlone) {
  for (const Blocks& blocks : all_blocks()) {
    for (const int dim : {2, 3}) {
      for (const int cells : {1, 3}) {
        for (const std::string& contact : {met, everything}) {
          const std::string text =
              told_of(block_text("one", dim, {1, 1, 1}, cells, {}) +
                          block_text("other", dim, blocks.lengths, cells, blocks.position),
                      contact);
          const std::string what = fmt::format("{} {}D of {}: {}", blocks.name, dim, cells, text);
          if (blocks.most == 0.0) {
            EXPECT_EQ(text, "not refused") << what;
            continue;
          }
          EXPECT_GE(depth_told(text), blocks.least) << what;
          EXPECT_LE(depth_told(text), blocks.most) << what;
          expect_words(text, {contact == met ? "interfaces.met.sides" : "contact.everything",
                              "at the start", ") m ", "initial.position"});
        }
      }
    }
  }
}

/// Facets on the far side of a thin body are no surface that a partner is behind.
TEST(StartsOfSurfaces, OfThinArchesAreApart) {
  for (const int cells : {8, 16}) {
    EXPECT_EQ(told_of(arch("one", 0.8, 1.0, 12) + arch("other", 1.05, 1.2, cells), met),
              "not refused")
        << cells;
    EXPECT_GT(depth_told(told_of(arch("one", 0.8, 1.0, 12) + arch("other", 0.9, 1.2, cells), met)),
              0.05)
        << cells;
  }
}

/// A list: of a pair that overlaps in several places, and of several pairs.
TEST(StartsOfSurfaces, TellAllPlaces) {
  const std::string table = block_text("one", 2, {4.0, 0.2}, 8, {});
  SolidText comb = solid("other", {});
  comb.mesh = "rectangle: {lengths: [4.0, 1.0], elements: [32, 2]}";
  comb.keys = "map: [\"x\", \"0.3 + y - (1 - y) * 0.2 * cos(3.141592653589793 * x) ^ 8\"], ";
  const std::string text = told_of(table + comb.text(), met);
  EXPECT_NEAR(depth_told(text), 0.1, 1.0e-3) << text;  // as it is printed
  // four sizes of a facet apart, and no node on a flush side
  expect_words(text, {"other.face at (1, 0.1) m", "other.face at (3, 0.1) m"});
  const std::string pairs =
      told_of(block_text("one", 2, {1, 1}, 3, {}) + block_text("other", 2, {1, 1}, 3, {0.3, 0.9}) +
                  block_text("third", 2, {1, 1}, 3, {0.3, -0.95}),
              everything);
  expect_words(pairs, {"overlap by 0.1 m", "overlap by 0.05 m", "third.face", "other.face"});
}

/// Blocks that the scene puts under a pressure of 2000 Pa by displacements, which a wall and a
/// traction hold: their surfaces without mass spring into each other at the first instant.
/// A block in a floor, of which one side each may touch.
std::string sole_in_floor(double y, const std::string& scheme, const std::string& contact) {
  return fmt::format(R"(time: {{end: 1.0, window: 0.5}}
bodies:
  block:
    model: {{fe: {{dimension: 2, mesh: {{rectangle: {{lengths: [0.2, 0.1], elements: [4, 2]}}}}}}}}
    material: {{linear_elastic: {{youngs_modulus: 1.0e6, poissons_ratio: 0.3, density: 1000.0}}}}
    integrator: {{{}: {{step: 0.5}}}}
    constraints: {{held: {{on: top, fixed: true}}}}
    initial: {{position: [0.0, {}]}}
    ports: {{sole: bottom}}
  floor:
    model:
      rigid_tool: {{dimension: 2, mesh: {{rectangle: {{lengths: [4.0, 1.0], elements: [1, 1]}}}}}}
    initial: {{position: [-2.0, -1.0]}}
    ports: {{face: top}}
{})",
                     scheme, number(y), contact);
}

/// Sides that are flat have boxes without height: those that have passed each other at the start
/// did not overlap, and bodies went through each other without a word.
TEST(StartsOfSurfaces, OfSidesThatHavePassedEachOtherAreSeenByEverything) {
  const std::string all = "contact: {everything: {}}\n",
                    one = "interfaces: {met: {sides: [block.sole, floor.face], contact: {}}}\n";
  for (const double depth : {1.0e-5, 1.0e-4, 9.0e-4}) {
    SCOPED_TRACE(depth);
    const std::string told = refusal([&] { run_text(sole_in_floor(-depth, "newmark", all)); });
    EXPECT_NE(told.find("its sides overlap by"), std::string::npos) << told;
    EXPECT_NE(told.find("write the pair under interfaces"), std::string::npos) << told;
  }
  // Deeper ones are told at the begin.
  const auto deep = run_text(sole_in_floor(-0.05, "newmark", all));
  ASSERT_EQ(deep->end.overlaps.size(), 1u);
  EXPECT_NEAR(deep->end.overlaps[0].depth, 0.05, roundoff(100.0, 0.05));
  // Statics press it out at once.
  const auto pressed = run_text(sole_in_floor(-1.0e-3, "quasi_static", all));
  const auto named = run_text(sole_in_floor(-1.0e-3, "quasi_static", one));
  ASSERT_TRUE(pressed->completed());
  EXPECT_LT(named->measure("body.block.held.reaction.y"), -1.0);
  EXPECT_EQ(pressed->measure("body.block.held.reaction.y"),
            named->measure("body.block.held.reaction.y"));
}

TEST(StartsOfSurfaces, ThatAreStressedAreInContact) {
  const auto run = run_text(R"yaml(meta: {title: stressed}
time: {begin: 0.0, end: 0.02, window: 1.0e-3}
bodies:
  held:
    model:
      fe:
        dimension: 2
        plane: strain
        mesh: {rectangle: {lengths: [1.0, 1.0], elements: [8, 2]}}
    material: {linear_elastic: {youngs_modulus: 1.0e6, poissons_ratio: 0.0, density: 1000.0}}
    integrator: {central_difference: {step: 1.0e-3}}
    initial: {position: [-1.0, 0.0], displacement_field: ["-0.002 * (x + 1)", "0"]}
    constraints: {wall: {on: left, x: "0"}, base: {on: bottom, y: "0"}}
    ports: {face: {side: right}}
  pressed:
    model:
      fe:
        dimension: 2
        plane: strain
        mesh: {rectangle: {lengths: [1.0, 1.0], elements: [8, 3]}}
    material: {linear_elastic: {youngs_modulus: 1.0e6, poissons_ratio: 0.0, density: 1000.0}}
    integrator: {central_difference: {step: 1.0e-3}}
    initial: {displacement_field: ["-0.002 - 0.002 * x", "0"]}
    constraints: {base: {on: bottom, y: "0"}}
    loads: {press: {on: right, traction: ["-2000.0", "0"]}}
    ports: {face: {side: left}}
interfaces: {met: {sides: [held.face, pressed.face], contact: {}}}
)yaml");
  EXPECT_TRUE(run->end.overlaps.empty());
  EXPECT_EQ(run->measure("contact.met.begin"), 0.0);
  // Contact bears the load, which gives 40 N s: most of it, as the kick of the first step makes the
  // blocks swing (measured 31.9); nothing at all where they pass through each other.
  EXPECT_GT(run->measure("contact.met.impulse"), 20.0);
  EXPECT_LT(run->measure("contact.met.impulse"), 60.0);
}

}  // namespace
}  // namespace abut::starts_of_surfaces_tests
