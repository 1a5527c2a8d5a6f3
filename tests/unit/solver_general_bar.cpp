// Goal: a bar by the model of solids is the bar of the bars' own core where both can be asked, and
// scenes reach it by what the core does not know.
// Oracles: the core's own steps; Hooke's law; the words of refusals.

#include <string>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/unit/shared_schemes.hpp"
#include "tests/unit/solver_cases.hpp"

namespace abut::solver_general_bar_tests {
/// Of finite elements in general, not the bars' core.
bool is_solid(const Subdomain& body) { return body.describe().model.starts_with("fe"); }

namespace {

/// A scene's text with a part of it put in place of another.
std::string with(std::string text, const std::string& part, const std::string& instead) {
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return text.replace(at, part.size(), instead);
}

std::unique_ptr<Subdomain> build_text(const std::string& body) {
  return make_body(Document::from_text("test", "bodies:\n" + body), "bodies.bar");
}

/// The bar by the model of solids.
std::unique_ptr<Subdomain> general(BarText bar) {
  bar.solid = true;
  return build(bar);
}

class GeneralBar : public testing::TestWithParam<SharedScheme> {};
INSTANTIATE_TEST_SUITE_P(Solver, GeneralBar, testing::ValuesIn(shared_schemes()),
                         [](const auto& s) { return s.param.name; });

TEST_P(GeneralBar, TakesTheStepsOfTheBarsOwnCore) {
  // Fixed on the left, in motion: a front runs to and fro.
  BarText text = case_bar({"", GetParam().integrator, GetParam().layer, {"right"}}, 0.3);
  text.fixed = "left";
  // With other masses the core starts the row beside a support without the support's share.
  const std::string& name = GetParam().name;
  if (name == "explicit" || name.ends_with("lumped")) text.body_force = -0.01;
  const std::unique_ptr<Subdomain> core = build(text);
  text.tied = "right";  // the end keeps its mass; without: tests/unit/solver_layer.cpp
  const std::unique_ptr<Subdomain> solid = general(text);
  ASSERT_TRUE(is_solid(*solid));
  ASSERT_FALSE(is_solid(*core));
  const int steps = 200;
  Response expected, found;
  const Advance request = free_request(*core, 0.0, steps * case_step);
  step(*core, request, expected);
  step(*solid, request, found);
  const Waveform &a = expected.ports[0].trace, &b = found.ports[0].trace;
  // Displacements reach 0.3 m/s times 40 s; each step rounds a handful of operations per node.
  // Newton's method ends at 1e-9 of the forces, but its one correction of a linear body is exact.
  const double rounding = roundoff(100.0 * steps, 12.0);
  EXPECT_LT(largest_difference(a.u, b.u), rounding);
  // The core puts out the velocity of an explicit port between its own steps only.
  if (name != "explicit") {
    EXPECT_LT(largest_difference(a.v, b.v), rounding);
  }
  EXPECT_GT(largest_size(a.u), 1.0);
  EXPECT_NEAR(found.records[0].momentum[0], expected.records[0].momentum[0], 40.0 * rounding);
  EXPECT_NEAR(solid->describe().mass, core->describe().mass, roundoff(40.0, 40.0));
}

BarText plain() { return case_bar({"plain", explicit_scheme(0.6), "massless: {}", {"right"}}); }

/// Without a contact layer, which is the core's.
BarText bare() {
  BarText text = plain();
  text.layer.clear();
  return text;
}

TEST(GeneralBar, HasPortsAtItsEnds) {
  BarText text = plain();
  text.sides = {"left", "right"};
  text.position = 2.0;
  const Description d = general(text)->describe();
  ASSERT_EQ(d.ports.size(), 2u);
  for (std::size_t p : {0u, 1u}) {
    const PortGeometry& g = d.ports[p].geometry;
    EXPECT_EQ(g.dim, 1);
    EXPECT_EQ(g.points, std::vector<double>{p == 0 ? 2.0 : 42.0});
    EXPECT_EQ(g.normals, std::vector<double>{p == 0 ? -1.0 : 1.0});
    EXPECT_NEAR(g.spacing, 1.0, roundoff(1.0, 40.0));
    EXPECT_TRUE(g.facets.empty() && g.offsets.empty());
  }
}

TEST(GeneralBar, KnowsTheStableStepOfItsOwnCore) {
  const double core = build(plain())->describe().stable_step;
  BarText text = plain();
  text.layer = "kick: {}";
  const double whole = build(text)->describe().stable_step;
  EXPECT_NEAR(whole, 1.0, roundoff(10.0, 1.0));  // h/c
  text = plain();
  // the bound of cells is rounded downwards by 1e-6
  EXPECT_NEAR(general(text)->describe().stable_step, whole, 2.0e-6);
  EXPECT_GT(core, 0.9);
}

/// The bodies of scenes with one thing that the core does not know.
TEST(GeneralBar, IsWhatTheCoreDoesNotKnow) {
  const std::string text = bare().text();
  const auto solid = [](const std::string& body) { return is_solid(*build_text(body)); };
  EXPECT_FALSE(solid(text));
  EXPECT_THROW(solid(with(text, "density", "poissons_ratio: 0.3, density")), InputError);
  EXPECT_TRUE(solid(with(text, "linear_elastic: {", "neo_hookean: {poissons_ratio: 0.3, ")));
  EXPECT_TRUE(solid(with(text, ", area", ", grading: 1.01, area")));
  EXPECT_TRUE(solid(text + "    constraints: {wall: {on: left, fixed: true}}\n"));
  EXPECT_FALSE(solid(text + "    loads: {pull: {on: right, traction: ['0.1 * t']}}\n"));
  const std::string held = text + "    supports: {left: fixed}\n";  // statics needs it
  EXPECT_FALSE(solid(held));
  EXPECT_TRUE(solid(with(held, explicit_scheme(0.6), "quasi_static: {step: 0.6}")));
}

std::string refusal(const std::string& body) {
  return abut::refusal([&body] { build_text(body); });
}

TEST(GeneralBar, RefusesWhatItDoesNotKnow) {
  const std::string load = "    loads: {pull: {on: right, pressure: '1', follows: true}}\n";
  EXPECT_NE(refusal(bare().text() + load).find("loads.pull.follows"), std::string::npos);
  const std::string clamp = "    constraints: {wall: {on: left, fixed: true}}\n";
  BarText text = bare();
  text.integrator = explicit_scheme(0.6, 6);
  EXPECT_NE(refusal(text.text() + clamp).find("dispersion_terms"), std::string::npos);
  text = plain();
  text.layer = "kick: {}";
  EXPECT_NE(refusal(text.text() + clamp).find("contact_layer"), std::string::npos);
  text = bare();
  text.integrator = "quasi_static: {step: 1.0}";
  text.tied = "right";
  EXPECT_NE(refusal(text.text() + clamp).find("ports.right.tied"), std::string::npos);
}

TEST(GeneralBar, StretchesAsHookesLawHasIt) {
  // Pulled by 2 Pa on the right and by its weight of 0.01 N/m; u(L) = (p L + b L^2/2)/E, exact at
  // the nodes.
  BarText text = bare();
  text.body_force = 0.01;
  text.fixed = "left";
  text.integrator = "quasi_static: {step: 1.0}";
  const std::unique_ptr<Subdomain> body =
      build_text(text.text() + "    loads: {pull: {on: right, traction: ['2.0 * t']}}\n");
  Response response;
  step(*body, free_request(*body, 0.0, 1.0), response);
  const double exact = 2.0 * 40.0 + 0.5 * 0.01 * 40.0 * 40.0;
  // a chain of 40 springs has a condition of 40^2
  EXPECT_NEAR(response.ports[0].trace.u.back(), exact, roundoff(1600.0, exact));
}

}  // namespace
}  // namespace abut::solver_general_bar_tests
