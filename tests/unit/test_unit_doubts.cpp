// Goal: numbers that cannot be meant are told of with key and remedy, and sensible ones are not.
// Oracle: hand-made bodies on both sides of each bound, and materials in the sets of units that
// engineers use.
#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/yaml_document.hpp"
#include "coordinator/body_table.hpp"
#include "coordinator/unit_doubts.hpp"
#include "subdomain_solver/make/material_doubt.hpp"

namespace abut::test_unit_doubts {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

struct TwoBodies {
  TwoBodies() {
    for (Description* body : {&small, &large}) {
      body->mass = 2.0;
      body->step = 1.0e-7;
      body->stable_step = 2.0e-7;
    }
    small.name = "small";
    large.name = "large";
    facts.resize(2);
    for (std::optional<BodyFacts>& of : facts) {
      of.emplace();
      of->low = {0.0, 0.0};
      of->high = {3.0, 4.0};
      of->wave_speed = 5000.0;
      of->size_key = "model.fe.mesh";
      of->step_key = "integrator.central_difference.step";
    }
  }
  std::vector<InputError> doubts() const {
    const Description* bodies[] = {&small, &large};
    return unit_doubts(bodies, facts, document);
  }
  std::string table() const {
    const Description* bodies[] = {&small, &large};
    return body_table(bodies, facts);
  }

  Description small, large;
  std::vector<std::optional<BodyFacts>> facts;
  Document document = Document::from_text("scene.yaml", R"(
bodies:
  small:
    model: {fe: {mesh: {disk: {}}}}
    integrator: {central_difference: {step: 1.0e-7}}
  large: {}
)",
                                          {});
};

TEST(UnitDoubts, AreNoneOfSensibleNumbers) { EXPECT_TRUE(TwoBodies().doubts().empty()); }

TEST(UnitDoubts, TellAStepFarBelowItsLimit) {
  TwoBodies two;
  two.small.stable_step = 0.99e-4;
  EXPECT_TRUE(two.doubts().empty());
  two.small.stable_step = 1.01e-4;
  ASSERT_EQ(two.doubts().size(), 1u);
  const InputError doubt = two.doubts()[0];
  EXPECT_EQ(doubt.where, "scene.yaml:5: bodies.small.integrator.central_difference.step");
  EXPECT_EQ(doubt.what_is_wrong,
            "1e-07 s is 1.01e+03 times below the 0.000101 s up to which explicit steps are stable");
  EXPECT_NE(doubt.remedy.find("units of the step"), std::string::npos);
}

TEST(UnitDoubts, TellABodyThatIsAboutAsFastAsItsWaves) {
  TwoBodies two;
  two.facts[0]->speed = 2499.0;
  EXPECT_TRUE(two.doubts().empty());
  two.facts[0]->speed = 10000.0;
  ASSERT_EQ(two.doubts().size(), 1u);
  const InputError doubt = two.doubts()[0];
  EXPECT_EQ(doubt.where, "scene.yaml:3: bodies.small.initial.velocity");
  EXPECT_EQ(doubt.what_is_wrong, "1e+04 m/s is 2 times the 5e+03 m/s of the body's fastest wave");
  EXPECT_NE(doubt.remedy.find("units of the velocity"), std::string::npos);
  two.facts[0]->wave_speed = 0.0;  // nothing deforms
  EXPECT_TRUE(two.doubts().empty());
}

TEST(UnitDoubts, KnowTheLimitOfImplicitStepsFromTheMesh) {
  TwoBodies two;
  two.small.stable_step = none;
  two.facts[0]->explicit_limit = 0.99e-4;
  EXPECT_TRUE(two.doubts().empty());
  two.facts[0]->explicit_limit = 1.01e-4;
  EXPECT_EQ(two.doubts().size(), 1u);
  two.facts[0]->explicit_limit = 0.0;  // not known
  EXPECT_TRUE(two.doubts().empty());
}

TEST(UnitDoubts, TellBodiesAMillionTimesApartInSize) {
  TwoBodies two;
  two.facts[0]->high = {3.0e-6, 4.0e-6};
  ASSERT_EQ(two.doubts().size(), 1u);
  EXPECT_EQ(two.doubts()[0].where, "scene.yaml:4: bodies.small.model.fe.mesh");
  EXPECT_EQ(two.doubts()[0].what_is_wrong,
            "makes a body of 5e-06 m from corner to corner, and that of 'large' is 5 m, 1e+06 "
            "times as large");
  two.facts[0]->high = {3.1e-6, 4.1e-6};
  EXPECT_TRUE(two.doubts().empty());
  two.facts[0].reset();  // a body of another program
  EXPECT_TRUE(two.doubts().empty());
}

TEST(UnitDoubts, TellWhatTheMaterialSays) {
  TwoBodies two;
  two.facts[1]->material_doubt = "density and stiffness do not go together";
  two.facts[1]->material_key = "material.linear_elastic";
  two.facts[1]->material_remedy = "Look at both.";
  ASSERT_EQ(two.doubts().size(), 1u);
  EXPECT_EQ(two.doubts()[0].what_is_wrong, "density and stiffness do not go together");
  EXPECT_EQ(two.doubts()[0].remedy, "Look at both.");
}

TEST(BodyTable, HasARowForEachBody) {
  TwoBodies two;
  two.large.mass = none;
  two.large.stable_step = none;
  two.facts[1]->explicit_limit = 1.0e-8;
  two.facts[0]->high = {3.0, 5.0};
  EXPECT_EQ(
      two.table(),
      "  body   extent [m]  mass [kg]  fastest wave [m/s]  step [s]  stable to [s]   "
      "stable/step\n"
      "  small       3 x 5          2                5000     1e-07          2e-07            "
      " 2\n"
      "  large       3 x 4  immovable                5000     1e-07          1e-08  0.1 "
      "implicit\n");
}

TEST(BodyTable, TellsManyEqualBodiesInOneRow) {
  TwoBodies two;
  std::vector<Description> balls(5, two.small);
  std::vector<const Description*> bodies;
  for (std::size_t k = 0; k < balls.size(); ++k) {
    balls[k].name = "ball_" + std::to_string(k + 1);
    bodies.push_back(&balls[k]);
  }
  const std::vector<std::optional<BodyFacts>> facts(5, two.facts[0]);
  EXPECT_NE(body_table(bodies, facts).find("  ball_1 to ball_5       3 x 4"), std::string::npos)
      << body_table(bodies, facts);
  EXPECT_EQ(body_table(std::span(bodies).first(3), std::span(facts).first(3)).find(" to ball"),
            std::string::npos);
}

const UnitSystem si;

UnitSystem system_of(const char* words) { return *UnitSystem::parse(words); }

TEST(MaterialDoubt, IsNoneOfSteelInAnySetOfUnits) {
  EXPECT_FALSE(material_doubt({7850.0, 2.1e11}, si, false));  // m kg s
  EXPECT_FALSE(material_doubt({7.85e-9, 2.1e5}, si, false));  // mm t s
  EXPECT_FALSE(material_doubt({7.85e-6, 210.0}, si, false));  // mm kg ms
  EXPECT_FALSE(material_doubt({7.8e-3, 2.05e5}, si, false));  // mm g ms, another steel
  EXPECT_FALSE(material_doubt({7.85, 2.1}, si, false));       // cm g us
  EXPECT_FALSE(material_doubt({7.85e-9, 2.1e5}, system_of("mm t s"), true));
  EXPECT_FALSE(material_doubt({7850.0, 2.1e5}, system_of("m kg ms"), true));  // it says so
}

TEST(MaterialDoubt, IsNoneOfRoundNumbersAndOfOtherMaterials) {
  EXPECT_FALSE(material_doubt({1.0, 1.0}, si, false));
  EXPECT_FALSE(material_doubt({1000.0, 1.0e9}, si, false));
  EXPECT_FALSE(material_doubt({1.0, 1.0e4}, si, false));
  EXPECT_FALSE(material_doubt({1100.0, 1.0e6}, si, true));    // rubber
  EXPECT_FALSE(material_doubt({1000.0, 1.0e3}, si, true));    // a gel
  EXPECT_FALSE(material_doubt({20.0, 1.0e5}, si, true));      // a foam
  EXPECT_FALSE(material_doubt({2768.0, 6.895e9}, si, true));  // a tenth of aluminium's stiffness
  EXPECT_FALSE(material_doubt({3515.0, 1.1e12}, si, true));   // diamond
}

TEST(MaterialDoubt, TellsPowersOfTenThatDoNotGoTogether) {
  const std::optional<MaterialDoubt> megapascals = material_doubt({7850.0, 2.1e5}, si, false);
  ASSERT_TRUE(megapascals);
  EXPECT_EQ(megapascals->what,
            "density 7850 and Young's modulus 2.1e+05 have the digits of steel, with powers of ten "
            "that do not go together");
  EXPECT_NE(megapascals->remedy.find("It has 7850 kg/m^3 and 210 GPa."), std::string::npos);
  EXPECT_TRUE(material_doubt({7.85e-9, 2.1e11}, si, false));
  EXPECT_TRUE(material_doubt({2700.0, 70.0}, si, true));    // GPa forgotten
  EXPECT_TRUE(material_doubt({7.85e-9, 2.1e5}, si, true));  // mm t s in SI
  EXPECT_TRUE(material_doubt({7850.0, 2.1e5}, system_of("mm t s"), true));
}

TEST(MaterialDoubt, TellsNumbersOfNoSolidWhereUnitsAreKnown) {
  EXPECT_TRUE(material_doubt({1.0e6, 1.0e9}, si, true));    // kg/m^3
  EXPECT_TRUE(material_doubt({1000.0, 1.0e13}, si, true));  // Pa
  EXPECT_TRUE(material_doubt({10.0, 1.0e12}, si, true));    // 3e5 m/s
  EXPECT_FALSE(material_doubt({1.0e6, 1.0e9}, si, false));
}

}  // namespace
}  // namespace abut::test_unit_doubts
