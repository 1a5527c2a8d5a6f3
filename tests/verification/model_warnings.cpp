// Goal: a run ends with a warning where a model does not fit what its body did, and without one
// where it does. Oracles: straight ways of nodes that turn without stress; a beam of one cell over
// its height, which bends by hourglasses alone.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::model_warnings_tests {
namespace {

/// A square turns freely, by 2 rad where nothing slows it.
ResultPtr turned(const std::string& model, const std::string& law, const std::string& integrator) {
  return run_solids(
      2.0e-3, 2.0e-4,
      {{.name = "square",
        .mesh = "rectangle: {lengths: [0.2, 0.2], elements: [4, 4], origin: centre}",
        .material = law + ": {youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000.0}",
        .integrator = integrator,
        .model = model,
        .keys = model == "modal" ? "modes: 4, " : "",
        .field = "\"-1000 * y\", \"1000 * x\""}});
}

std::vector<std::string> warnings(const RunResult& run) {
  std::vector<std::string> out;
  for (const RunEvent& event : run.events)
    if (event.kind == RunEvent::Kind::warning) out.push_back(event.text);
  return out;
}

TEST(ModelWarnings, TellOfALinearLawThatHasTurned) {
  const std::string explicit_steps = "central_difference: {step: 2.0e-6}";
  const std::string implicit_steps = "newmark: {step: 1.0e-5}";
  const std::pair<std::string, std::string> cases[] = {
      {"fe", explicit_steps}, {"fe", implicit_steps}, {"modal", implicit_steps}};
  for (const auto& [model, integrator] : cases) {
    const ResultPtr run = turned(model, "linear_elastic", integrator);
    ASSERT_TRUE(run->completed()) << model;
    // Nodes fly straight: u = w t x X, without strain; sums of a thousand steps.
    EXPECT_NEAR(run->measure("body.square.rotation.max"), 2.0, roundoff(1.0e5, 2.0)) << model;
    EXPECT_NEAR(run->measure("body.square.displacement.x.max"), 0.2, roundoff(1.0e5, 0.2)) << model;
    ASSERT_EQ(warnings(*run).size(), 1u) << model;
    EXPECT_NE(warnings(*run)[0].find("'square' has turned by up to 2 rad"), std::string::npos)
        << warnings(*run)[0];
  }
}

TEST(ModelWarnings, AreNoneOfModelsThatMayTurn) {
  const ResultPtr finite =
      turned("fe", "saint_venant_kirchhoff", "central_difference: {step: 2.0e-6}");
  ASSERT_TRUE(finite->completed());
  EXPECT_TRUE(warnings(*finite).empty()) << warnings(*finite)[0];
  const ResultPtr rigid = turned("rigid", "linear_elastic", "rigid_motion: {step: 1.0e-5}");
  ASSERT_TRUE(rigid->completed());
  EXPECT_TRUE(warnings(*rigid).empty()) << warnings(*rigid)[0];
}

/// A beam of n cells of one point over its height, bent by a pull across its end.
ResultPtr bent(int n) {
  return run_solids(
      1.0, 1.0,
      {{.name = "beam",
        .material = "linear_elastic: {youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000.0}",
        .integrator = "quasi_static: {step: 1.0}",
        .keys = "plane: strain, formulation: one_point, ",
        .more = "    constraints: {wall: {on: left, fixed: true}}\n"
                "    loads: {pull: {on: right, traction: [\"0\", \"1.0e3 * t\"]}}\n",
        .block = {{1.0, 0.1}, {10 * n, n}}}});
}

TEST(ModelWarnings, TellOfBendingByHourglasses) {
  const ResultPtr coarse = bent(1), fine = bent(8);
  ASSERT_TRUE(coarse->completed() && fine->completed());
  // What one mean gradient over the height does not see is the moment: only shear is left.
  EXPECT_GT(coarse->measure("body.beam.energy.hourglass_share"), 0.9);
  ASSERT_EQ(warnings(*coarse).size(), 1u);
  EXPECT_NE(warnings(*coarse)[0].find("in hourglasses"), std::string::npos) << warnings(*coarse)[0];
  // Steps of strain leave 1/8^2 of the moment to the hourglasses, whose stiffness is a twentieth.
  EXPECT_LT(fine->measure("body.beam.energy.hourglass_share"), 0.01);
  EXPECT_TRUE(warnings(*fine).empty()) << warnings(*fine)[0];
}

}  // namespace
}  // namespace abut::model_warnings_tests
