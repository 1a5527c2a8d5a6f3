// Goal: surfaces that overlap at the start, or nearly touch, are moved onto each other without
// stress, whichever side is asked to and whatever the bodies are; then they rest, and from the
// first window on they press. What cannot be adjusted is refused with the reason. Oracles: bodies
// at rest stay at rest, to the last bit; balance of momentum and energy; the same start is refused
// without the key.

#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/refusal.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::adjusted_surfaces_tests {
namespace {

/// Two blocks with a bump that fit each other, but for their facets and for `deep` [m].
struct Start {
  std::string name;
  int dim = 2;
  std::string lower = "fe", upper_scheme = "central_difference", lower_scheme = upper_scheme;
  bool lower_adjusts = false;
  double deep = 0.01, gaps = 0.0, speed = 0.0, end = 0.05;
  std::string element, rows = "mortar";
};

void PrintTo(const Start& start, std::ostream* out) { *out << start.name; }

SolidText body(const Start& start, const std::string& name, const std::string& model, int across,
               const std::string& scheme, const std::string& side, bool adjusts, double place,
               double speed) {
  SolidText out{
      .name = name,
      .position = {0.0, place},
      .side = side,
      .model = model,
      .keys = fmt::format("{}map: [x, y + 0.1 * sin(3.141592653589793 * x){}], ",
                          model == "modal" ? "modes: 4, " : "", start.dim == 3 ? ", z" : ""),
      .block = {{1.0, 0.25}, {across, 2}, start.element}};
  if (start.dim == 3) {
    out.block.lengths.push_back(0.5);
    out.block.cells.push_back(across / 2);
  }
  if (model != "rigid_tool") {
    out.material = unit_law("linear_elastic", 0.3);
    out.integrator = implicit_scheme(model == "rigid" ? "rigid_motion" : scheme, 0.005);
  }
  if (start.lower != "rigid_tool" || name == "upper") out.velocity = {0.0, speed};
  if (adjusts) out.start = fmt::format("adjust: true, adjust_gaps: {}", number(start.gaps));
  return out;
}

std::string text(const Start& start, bool adjusts = true) {
  const bool lower = start.lower_adjusts;
  return scene_text(
      start.end, 0.005,
      texts_of({body(start, "lower", start.lower, 7, start.lower_scheme, "top", adjusts && lower,
                     0.0, start.speed),
                body(start, "upper", "fe", 10, start.upper_scheme, "bottom", adjusts && !lower,
                     0.25 - start.deep, -start.speed)}),
      fmt::format(
          "interfaces: {{fit: {{sides: [lower.face, upper.face], contact: {{rows: {}}}}}}}\n",
          start.rows));
}

ResultPtr run(const Start& start) { return run_text(text(start)); }

std::string refused(const std::string& scene) {
  return refusal([&scene] { run_text(scene); });
}

std::vector<Start> starts() {
  std::vector<Start> out;
  for (const int dim : {2, 3}) {
    for (const char* lower : {"fe", "rigid", "rigid_tool", "modal"}) {
      for (const char* scheme : {"central_difference", "newmark"}) {
        for (const bool lower_adjusts : {false, true}) {
          for (const double deep : {0.01, -0.002}) {
            if (lower == std::string("modal") && dim == 3 && deep < 0.0)
              continue;  // 2 s of the same
            Start start;
            start.dim = dim;
            start.lower = lower;
            start.upper_scheme = start.lower_scheme = scheme;
            start.lower_adjusts = lower_adjusts;
            start.deep = deep;
            if (deep < 0.0) start.gaps = 0.03;
            start.name =
                fmt::format("{}d_{}_{}_{}_{}", dim, lower, scheme,
                            lower_adjusts ? "lower" : "upper", deep > 0.0 ? "deep" : "apart");
            out.push_back(start);
          }
        }
      }
    }
  }
  for (const char* element : {"tri3", "tri6", "quad8", "tet4", "tet10", "hex20"}) {
    Start start;
    start.dim = element_named(element).dim;
    start.element = element;
    start.name = element;
    start.upper_scheme = start.lower_scheme = "newmark";
    out.push_back(start);
  }
  for (const bool lower_adjusts : {false, true}) {
    for (const char* lower : {"fe", "rigid_tool"}) {
      Start start;
      start.lower = lower;
      start.lower_adjusts = lower_adjusts;
      start.rows = "point_to_surface";
      start.name = fmt::format("{}_points_{}", lower, lower_adjusts ? "lower" : "upper");
      out.push_back(start);
    }
  }
  return out;
}

class AdjustedStart : public testing::TestWithParam<Start> {};
INSTANTIATE_TEST_SUITE_P(Combinations, AdjustedStart, testing::ValuesIn(starts()),
                         [](const auto& s) { return s.param.name; });

TEST_P(AdjustedStart, RestsWithoutForceAndIsRefusedWithoutTheKey) {
  const Start& start = GetParam();
  const auto result = run(start);
  ASSERT_TRUE(result->completed());
  for (const RunResult::Row& row : result->rows) {
    for (const double energy : row.total) EXPECT_EQ(energy, 0.0) << row.time;
    for (const double momentum : row.momentum) EXPECT_EQ(momentum, 0.0) << row.time;
  }
  if (start.deep < 0.0) return;
  const std::string message = refused(text(start, false));
  EXPECT_NE(message.find("adjust: true"), std::string::npos) << message;
}

TEST_P(AdjustedStart, PressesFromTheFirstWindowOn) {
  Start start = GetParam();
  start.speed = 0.01;
  start.end = 0.4;
  if (start.dim == 3) start.end = 0.1;
  const auto result = run(start);
  ASSERT_TRUE(result->completed());
  // The layer's masses have moved on for half a step before the faces are one.
  const std::vector<double> closed = result->times(RunEvent::Kind::contact_closed, "fit");
  ASSERT_FALSE(closed.empty());
  EXPECT_LE(closed.front(), 0.005 + roundoff(4.0, 0.005));
  if (start.lower == "rigid_tool") return;
  const bool is_explicit = start.upper_scheme.starts_with("central");
  // Rounding; where bodies solve equations, 1e-9 of the forces in every step.
  EXPECT_LE(result->measure("momentum.total"), is_explicit ? 1.0e-12 : 1.0e-8);
}

Start flat(const std::string& name) {
  Start start;
  start.name = name;
  return start;
}

void replace(std::string& text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  ASSERT_NE(at, std::string::npos) << what;
  text.replace(at, what.size(), by);
}

void expect_words(const std::string& message, std::initializer_list<const char*> words) {
  for (const char* word : words)
    EXPECT_NE(message.find(word), std::string::npos) << "no '" << word << "' in: " << message;
}

TEST(AdjustRefusals, BothSides) {
  std::string scene = text(flat("both"));
  replace(scene, "velocity: [0.0", "adjust: true, velocity: [0.0");
  expect_words(refused(scene), {"initial.adjust: is true of both sides of the interface fit",
                                "Let one of them stay"});
}

TEST(AdjustRefusals, ABodyThatTouchesNothing) {
  std::string scene = text(flat("alone"));
  scene.resize(scene.find("interfaces:"));
  expect_words(refused(scene), {"initial.adjust: has no effect", "no interface"});
}

TEST(AdjustRefusals, APartnerOfAnotherProgram) {
  std::string scene = text(flat("external"));
  const std::size_t from = scene.find("  lower:"), to = scene.find("  upper:");
  scene.replace(from, to - from,
                "  lower: {model: {external: {}}, launch: {spawn: {program: body.py}}}\n");
  expect_words(refused(scene), {"initial.adjust", "only its own program knows"});
}

TEST(AdjustRefusals, ADepthThatTurnsCellsOver) {
  Start start = flat("deep");
  start.deep = 0.135;  // cells are 0.125 high
  expect_words(refused(text(start)),
               {"bodies.upper.initial.adjust: moves nodes by up to 0.13", "inverted or degenerate",
                "the first is cell ", "quad4 around"});
}

TEST(AdjustRefusals, GapsBeyondAFacet) {
  Start start = flat("gaps");
  start.gaps = 0.2;
  expect_words(refused(text(start)), {"adjust_gaps: is 0.2 m", "facets of the body", "fit"});
}

TEST(AdjustRefusals, NodesThatAreHeld) {
  std::string scene = text(flat("held"));
  const std::size_t upper = scene.find("  upper:");
  scene.insert(scene.find("    ports:", upper),
               "    constraints: {all: {on: bottom, fixed: true}}\n");
  expect_words(refused(scene), {"initial.adjust: leaves an overlap of 0.009", "interface fit"});
}

TEST(AdjustRefusals, WallsAndBars) {
  const std::string scene =
      "meta: {title: test}\ntime: {begin: 0.0, end: 1.0, window: 1.0}\nbodies:\n"
      "  bar: {model: {fe: {dimension: 1, mesh: {bar: {length: 1.0, area: 1.0, elements: 4}}}}, "
      "material: {linear_elastic: {youngs_modulus: 1.0, density: 1.0}}, "
      "integrator: {central_difference: {step: 0.125}}, initial: {adjust: true}}\n";
  expect_words(refused(scene), {"initial.adjust: has no effect", "two and three dimensions"});
}

}  // namespace
}  // namespace abut::adjusted_surfaces_tests
