// Goal: a body that comes upon itself is kept off itself, alone or among others, by the passive way
// alone; where a scene forbids it the run tells of it. Oracles: facets of its surface that pass
// through each other, counted by the body at its records; momentum; energy that does not grow. Each
// scene is run without contact of bodies with themselves as well, where facets must pass: so it is
// the contact that keeps them apart.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/refusal.hpp"
#include "tests/support/runs.hpp"

namespace abut::self_contact_tests {
namespace {

/// Of the energy at the start: the account of a step may gain a thousandth of it before it is
/// refused, and gives that back.
constexpr double grown = 1.0e-3;
/// Of the momentum of the body: Newton's iterations end at 1e-10 of the forces.
constexpr double momentum_kept = 1.0e-7;

const std::string apart = "contact: {self: false}\n";

/// A strip bent to most of a ring, whose ends are thrown at each other, or away.
SolidText horseshoe(const std::string& law, double speed, const std::string& scheme) {
  return {.name = "shoe",
          .material = unit_law(law, 0.3),
          .integrator = scheme,
          .port = "skin",
          .side = "boundary",
          .keys = "map: [(1 + x) * cos(0.3 + 0.16 * y), (1 + x) * sin(0.3 + 0.16 * y)], ",
          .field = fmt::format("\"0\", \"{} * y * exp(3 * (x - 1))\"", number(speed)),
          .block = {{0.2, 36.0}, {2, 36}}};
}

SolidText far_wall() { return tool("wall", {{1.0, 1.0}, {2, 2}}, {9.0}, "left"); }

bool warned(const RunResult& result) {
  return std::ranges::any_of(result.events, [](const RunEvent& event) {
    return event.kind == RunEvent::Kind::warning &&
           event.text.find("passed through each other") != std::string::npos;
  });
}

void expect_apart(const RunResult& result, const std::string& body) {
  ASSERT_TRUE(result.completed()) << result.end.reason;
  EXPECT_EQ(result.measure("body." + body + ".contact.crossings"), 0.0);
  EXPECT_FALSE(warned(result));
  EXPECT_GT(result.end.given_up.windows, 0);
}

/// The scene without the contact: what would happen.
void expect_passing(const RunResult& result, const std::string& body) {
  ASSERT_TRUE(result.completed()) << result.end.reason;
  EXPECT_GT(result.measure("body." + body + ".contact.crossings"), 0.0);
  EXPECT_TRUE(warned(result));
}

TEST(SelfContact, KeepsAHorseshoeOffItself) {
  for (const std::string scheme : {"central_difference: {step: 0.01}", "newmark: {step: 0.025}"}) {
    for (const bool alone : {true, false}) {
      SCOPED_TRACE(scheme + (alone ? " alone" : " beside a wall"));
      std::vector<SolidText> bodies = {horseshoe("neo_hookean", -1.0, scheme)};
      if (!alone) bodies.push_back(far_wall());
      const std::string interface = alone ? "" : touching("touch", "shoe.skin", "wall.face");
      const auto result = run_solids(3.0, 0.05, bodies, interface);
      expect_apart(*result, "shoe");
      EXPECT_LT(result->energy_error(), grown);
      if (alone) {
        EXPECT_LT(result->measure("momentum.total"), momentum_kept);
      }
      expect_passing(*run_solids(3.0, 0.05, bodies, interface, apart), "shoe");
    }
  }
}

/// The law of everything is that of a body with itself, where there is no other.
TEST(SelfContact, OfABodyAloneHasTheLawOfEverything) {
  const std::vector<SolidText> bodies = {horseshoe("neo_hookean", -1.0, "newmark: {step: 0.025}")};
  for (const double friction : {0.0, 0.5}) {
    SCOPED_TRACE(friction);
    const auto result =
        run_solids(3.0, 0.05, bodies, "",
                   fmt::format("contact: {{everything: {{friction: {}}}}}\n", friction));
    expect_apart(*result, "shoe");
    EXPECT_EQ(result->end.given_up.friction > 0.0, friction > 0.0);
  }
}

/// It may be the only contact that a scene says, and must be of a body that can fold.
TEST(SelfContact, MayBeSaidAlone) {
  const std::string scheme = "newmark: {step: 0.025}";
  const std::vector<SolidText> bodies = {horseshoe("neo_hookean", -1.0, scheme)};
  const auto said = run_solids(3.0, 0.05, bodies, "", "contact: {self: true}\n");
  expect_apart(*said, "shoe");
  EXPECT_EQ(said->end.body_hashes, run_solids(3.0, 0.05, bodies, "")->end.body_hashes);
  const auto refused = [&](const std::string& law, const char* contact) {
    return refusal([&] { run_solids(3.0, 0.05, {horseshoe(law, -1.0, scheme)}, "", contact); });
  };
  expect_words(refused("linear_elastic", "contact: {self: true}\n"),
               {"contact.self", "has no effect", "no body that strains finitely"});
  expect_words(refused("neo_hookean", "contact: {}\n"),
               {"contact.everything", "is missing", "contact: {self: true}"});
}

/// Nothing is given up where a body does not come upon itself, and small strains do not fold one.
TEST(SelfContact, LeavesOthersToTheAccurateMethod) {
  const std::string scheme = "central_difference: {step: 0.01}";
  for (const std::string law : {"neo_hookean", "linear_elastic"}) {
    const auto result = run_solids(1.5, 0.05, {horseshoe(law, 0.2, scheme), far_wall()},
                                   touching("touch", "shoe.skin", "wall.face"));
    ASSERT_TRUE(result->completed());
    EXPECT_EQ(result->end.given_up.windows, 0);
    const auto without = run_solids(1.5, 0.05, {horseshoe(law, 0.2, scheme), far_wall()},
                                    touching("touch", "shoe.skin", "wall.face"), apart);
    EXPECT_EQ(result->end.body_hashes, without->end.body_hashes);
    EXPECT_EQ(result->measures.values.contains("body.shoe.contact.crossings"),
              law == "neo_hookean");
  }
}

/// Ends that are ports of their own, without a node in common.
TEST(SelfContact, IsThatOfPortsOfOneBodyToo) {
  SolidText shoe = horseshoe("neo_hookean", -1.0, "central_difference: {step: 0.01}");
  shoe.side = "";
  for (const bool both : {true, false}) {
    shoe.sides = both ? std::vector<std::string>{"bottom", "top"} : std::vector<std::string>{"top"};
    const auto result = run_solids(3.0, 0.05, {shoe});
    ASSERT_TRUE(result->completed());
    EXPECT_EQ(result->end.given_up.windows > 0, both);
  }
}

/// An open ring between two tools.
TEST(SelfContact, KeepsACrushedRingOffItself) {
  const SolidText ring{
      .name = "ring",
      .material = "neo_hookean: {youngs_modulus: 2.0e4, poissons_ratio: 0.3, density: 1000.0}",
      .integrator = implicit_scheme("generalized_alpha", 0.01),
      .port = "skin",
      .side = "boundary",
      .keys = "map: [(1 + x) * cos(0.3 + 0.142 * y), (1 + x) * sin(0.3 + 0.142 * y)], ",
      .block = {{0.08, 40.0}, {2, 40}}};
  const SolidText upper =
      tool("upper", {{4.0, 0.2}, {4, 1}}, {-2.0, 1.09}, "bottom", "way: [\"0\", \"-0.8 * t\"], ");
  const SolidText lower = tool("lower", {{4.0, 0.2}, {4, 1}}, {-2.0, -1.29}, "top");
  const std::string all = "contact: {everything: {friction: 0.1}";
  expect_apart(*run_solids(2.0, 0.02, {ring, upper, lower}, "", all + "}\n"), "ring");
  expect_passing(*run_solids(2.0, 0.02, {ring, upper, lower}, "", all + ", self: false}\n"),
                 "ring");
}

/// A mat whose ends turn against each other, beyond where it comes upon itself.
TEST(SelfContact, KeepsATwistedMatOffItself) {
  const auto turned = [](const std::string& sign) {
    const std::string c = "cos(6.283185 * t)", s = sign + "sin(6.283185 * t)";
    return fmt::format(
        "x: \"0\", y: \"(y - 0.5) * ({0} - 1) - (z - 0.03) * ({1})\", "
        "z: \"(y - 0.5) * ({1}) + (z - 0.03) * ({0} - 1)\"",
        c, s);
  };
  for (const std::string element : {"hex8", "tet4"}) {
    SCOPED_TRACE(element);
    const SolidText mat{
        .name = "mat",
        .material = "neo_hookean: {youngs_modulus: 2.0e4, poissons_ratio: 0.3, density: 1000.0}",
        .integrator = implicit_scheme("generalized_alpha", 0.01),
        .port = "skin",
        .side = "boundary",
        .more = fmt::format("    constraints: {{one: {{on: left, {}}}, two: {{on: right, {}}}}}\n",
                            turned(""), turned("-")),
        .block = {{2.0, 1.0, 0.06}, {12, 6, 1}, element}};
    expect_apart(*run_solids(0.8, 0.02, {mat}), "mat");
    expect_passing(*run_solids(0.8, 0.02, {mat}, "", apart), "mat");
  }
}

}  // namespace
}  // namespace abut::self_contact_tests
