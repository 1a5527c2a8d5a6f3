// Goal: ties that ask for what cannot be are refused by name, whatever gives the motions and
// however bodies step; ties that say the same twice go on. Oracles: the motions that are given.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::tied_contradictions_tests {
namespace {

/// How fast what is given moves [m/s], and its distance at the end of the first window [m].
constexpr double speed = 0.01, window = 0.1, gone = speed * window;

/// A square of side 1 with ports on its sides. No integrator: a tool on its way.
std::string square(const std::string& name, double x, const std::string& integrator,
                   const std::string& more, const std::string& law = "linear_elastic",
                   const std::string& model = "fe") {
  const bool tool = integrator.empty();
  return SolidText{.name = name,
                   .material = tool ? "" : unit_law(law, 0.3),
                   .integrator = integrator,
                   .position = {x},
                   .model = tool ? "rigid_tool" : model,
                   .keys = tool ? "way: [" + more + "], " : "",
                   .sides = {"left", "right"},
                   .more = tool ? "" : more,
                   .block = {{1.0, 1.0}, {3, 3}}}
      .text();
}

const std::string moves = "\"0.01*t\", 0", stands = "0, 0";

std::string held(const std::string& sides) { return "    constraints: {" + sides + "}\n"; }

using Ties = std::vector<std::array<std::string, 2>>;

ResultPtr run(const std::string& bodies, const Ties& ties, const std::string& more = "") {
  std::string interfaces = "interfaces:\n";
  for (std::size_t k = 0; k < ties.size(); ++k)
    interfaces += joined(fmt::format("tie{}", k), ties[k][0], ties[k][1]);
  return run_scene(0.5, window, bodies, interfaces + more);
}

void expect_refused(const RunResult& result, const std::vector<std::string>& words) {
  EXPECT_EQ(result.end.status, "failed");
  EXPECT_EQ(result.end.windows, 0);  // nothing before is known to be right
  ASSERT_FALSE(result.events.empty());
  for (const std::string& word : words)
    EXPECT_NE(result.events.back().text.find(word), std::string::npos)
        << word << " is not in: " << result.events.back().text;
}

struct Way {
  std::string integrator, law, more;
};

std::vector<Way> ways() {
  std::vector<Way> all;
  for (const char* law : {"linear_elastic", "saint_venant_kirchhoff"})
    for (const char* integrator :
         {"newmark: {step: 0.02}", "central_difference: {step: 0.02}", "quasi_static: {step: 0.1}"})
      all.push_back({integrator, law, ""});
  for (const char* policy : {"halve", "accept"})
    all.push_back({"newmark: {step: 0.02}", "linear_elastic",
                   fmt::format("schwarz: {{on_nonconvergence: {}}}\n", policy)});
  for (const char* integrator : {"newmark: {step: 0.02}", "central_difference: {step: 0.02}"})
    all.push_back({integrator, "linear_elastic", "schwarz: {ties: {band: waves}}\n"});
  return all;
}

/// What is given is as far apart as it went.
std::string apart() { return fmt::format("{:g} m apart", gone); }

TEST(TiedContradictions, GivenMotionsThatDifferAreToldByName) {
  for (const Way& way : ways()) {
    SCOPED_TRACE(way.integrator + " " + way.law + " " + way.more);
    const auto body = [&way](const char* name, double x, const std::string& more) {
      return square(name, x, way.integrator, more, way.law);
    };
    {
      SCOPED_TRACE("both sides are held, and the one moves");
      const auto result =
          run(body("a", 0.0, held("wall: {on: left, fixed: true}, end: {on: right, fixed: true}")) +
                  body("b", 1.0, held("end: {on: left, x: \"0.01*t\", y: 0}")),
              {{"a.right", "b.left"}}, way.more);
      expect_refused(*result, {"interfaces.tie0", apart(), "at (1, ", "bodies a, b"});
    }
    {
      SCOPED_TRACE("they differ in a corner");
      const auto result = run(
          body("a", 0.0, held("floor: {on: bottom, fixed: true}, lid: {on: top, y: \"0.01*t\"}")) +
              body("b", 1.0, held("floor: {on: bottom, fixed: true}, lid: {on: top, y: 0}")),
          {{"a.right", "b.left"}}, way.more);
      expect_refused(*result, {"interfaces.tie0", apart(), "at (1, 1)", "bodies a, b"});
    }
    {
      SCOPED_TRACE("a tool moves what is held");
      const auto result = run(
          body("a", 0.0, held("end: {on: right, fixed: true}")) + square("tool", 1.0, "", moves),
          {{"a.right", "tool.left"}}, way.more);
      expect_refused(*result, {"interfaces.tie0", "m apart at (1, ", "bodies a, tool"});
    }
    {
      SCOPED_TRACE("two tools on one port part");
      const auto result =
          run(body("a", 0.0, "") + square("p", 1.0, "", moves) + square("q", 1.0, "", stands),
              {{"a.right", "p.left"}, {"a.right", "q.left"}}, way.more);
      expect_refused(*result, {"interfaces.tie0", "interfaces.tie1", "m apart at (1, ", "p", "q"});
    }
  }
  const auto rigid =
      run(square("a", 0.0, "rigid_motion: {step: 0.02}", "", "linear_elastic", "rigid") +
              square("p", 1.0, "", moves) + square("q", -1.0, "", stands),
          {{"a.right", "p.left"}, {"q.right", "a.left"}});
  expect_refused(*rigid, {"interfaces.tie0", "interfaces.tie1", "bodies a, p, q"});
}

/// Rows that say the same twice: clamps across a joint, motions that agree, tools that pull a body.
TEST(TiedContradictions, GivenMotionsThatAgreeGoOn) {
  for (const Way& way : ways()) {
    SCOPED_TRACE(way.integrator + " " + way.law + " " + way.more);
    const auto body = [&way](const char* name, double x, const std::string& more) {
      return square(name, x, way.integrator, more, way.law);
    };
    const std::string lifted =
        held("floor: {on: bottom, fixed: true}, lid: {on: top, y: \"0.01*t\"}");
    const auto clamped =
        run(body("a", 0.0, lifted) + body("b", 1.0, lifted), {{"a.right", "b.left"}}, way.more);
    EXPECT_TRUE(clamped->completed());
    const std::string slid =
        held("floor: {on: bottom, x: 0}, end: {on: SIDE, x: 0, y: \"0.01*t\"}");
    const auto with = [&slid](const std::string& side) {
      return std::string(slid).replace(slid.find("SIDE"), 4, side);
    };
    const auto moved = run(body("a", 0.0, with("right")) + body("b", 1.0, with("left")),
                           {{"a.right", "b.left"}}, way.more);
    EXPECT_TRUE(moved->completed());
    const auto pulled =
        run(body("a", 0.0, "") + square("p", 1.0, "", moves) + square("q", -1.0, "", stands),
            {{"a.right", "p.left"}, {"q.right", "a.left"}}, way.more);
    EXPECT_TRUE(pulled->completed());
    EXPECT_NEAR(pulled->measure("body.a.right.displacement.x"), 0.005, 0.005 * iteration(1.0e-6));
    const auto twice =
        run(body("a", 0.0, "") + square("p", 1.0, "", moves) + square("q", 1.0, "", moves),
            {{"a.right", "p.left"}, {"a.right", "q.left"}}, way.more);
    EXPECT_TRUE(twice->completed());
  }
}

/// A floor of two parts under its weight, in steps far below their limits: a corner without mass
/// gives way 1e7 times as much as nodes with mass beside it, and these are moved all the same.
TEST(TiedContradictions, PartsOfAFloorInShortStepsGoOn) {
  for (const char* law : {"neo_hookean", "linear_elastic"}) {
    for (const char* integrator : {"hht_alpha", "newmark", "central_difference"}) {
      for (const std::array<int, 2>& cells : {std::array{2, 4}, {4, 2}, {3, 4}}) {
        SCOPED_TRACE(fmt::format("{} {} {}:{}", law, integrator, cells[0], cells[1]));
        const auto part = [&](const char* name, double x, int count, const std::string& scheme) {
          return SolidText{
              .name = name,
              .material = unit_law(law, 0.3),
              .integrator = scheme,
              .position = {x},
              .sides = {"left", "right", "top"},
              .more = held("base: {on: bottom, fixed: true}") + "    body_force: [0, -1]\n",
              .block = {{1.0, 1.0}, {1, count}}}
              .text();
        };
        const std::string hammer = SolidText{
            .name = "hammer",
            .material = unit_law("linear_elastic", 0.3),
            .integrator = "central_difference: {step: 0.8e-4}",
            .position = {1.0, 1.5},
            .sides = {"bottom"},
            .block = {{1.0, 1.0},
                      {1, 1}}}.text();
        const ResultPtr result = run_scene(
            3.2e-3, 3.2e-4,
            part("a", 0.0, cells[0], fmt::format("{}: {{step: 0.4e-4}}", integrator)) +
                part("b", 1.0, cells[1], "central_difference: {step: 0.8e-4}") + hammer,
            "interfaces:\n  hit: {sides: [b.top, hammer.bottom], contact: {}}\n" +
                joined("tie", "a.right", "b.left"));
        EXPECT_TRUE(result->completed()) << result->end.reason;
        EXPECT_EQ(result->end.windows, 10);
      }
    }
  }
}

/// Two blocks side by side, both moved along an edge of the joint by what the scene writes.
std::string moved_along(const std::array<int, 2>& cells, const std::string& way,
                        const std::string& other, const std::string& integrator) {
  std::string text;
  for (const std::size_t k : {0u, 1u})
    text += SolidText{.name = k == 0 ? "a" : "b",
                      .material = unit_law("linear_elastic", 0.3),
                      .integrator = integrator,
                      .position = {k == 0 ? 0.0 : 0.5},
                      .sides = {k == 0 ? "right" : "left"},
                      .more = fmt::format(
                          "    constraints: {{base: {{on: bottom, x: 0, z: 0, y: \"{}\"}}}}\n",
                          k == 0 ? way : other),
                      .block = {{0.5, 0.5, 1.0}, {2, 2, cells[k]}}}
                .text();
  return text;
}

/// One motion that bends between the nodes of unlike meshes is no contradiction; a straight one
/// that differs is, however little, and so is one that differs by more than meshes leave.
TEST(TiedContradictions, MeshesThatFollowOneCurveGoOn) {
  const std::string curve = "0.01*t*sin(3*z)", more = "0.01*t*sin(3*z) + 0.001*t";
  for (const char* integrator :
       {"quasi_static: {step: 0.1}", "newmark: {step: 0.02}", "central_difference: {step: 0.01}"}) {
    for (const std::array<int, 2>& cells :
         {std::array{3, 4}, {4, 3}, {6, 8}, {12, 16}, {24, 16}, {7, 11}}) {
      SCOPED_TRACE(fmt::format("{} {}:{}", integrator, cells[0], cells[1]));
      const Ties tie = {{"a.right", "b.left"}};
      EXPECT_TRUE(run(moved_along(cells, curve, curve, integrator), tie)->completed());
      expect_refused(*run(moved_along(cells, "0.0001*t*z", "0.0001*t", integrator), tie),
                     {"interfaces.tie0", "bodies a, b"});
      if (cells[0] < 6) continue;  // these leave as much
      expect_refused(*run(moved_along(cells, curve, more, integrator), tie),
                     {"interfaces.tie0", "bodies a, b"});
    }
  }
}

}  // namespace
}  // namespace abut::tied_contradictions_tests
