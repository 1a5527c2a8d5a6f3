// Goal: the word rigid in place of fe makes the same body without its deformation. Oracle: the same
// scene in both rungs: what does not depend on deformation is equal to round-off.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::rigid_rung_tests {
namespace {

ResultPtr run_shipped(const std::string& scene, const std::vector<std::string>& overrides) {
  return run_file(std::string(ABUT_SOURCE_DIR) + "/configs/solids/" + scene + ".yaml", overrides);
}

TEST(RigidRung, OfTheSpinningBodyHasItsMomenta) {
  const ResultPtr fe = run_shipped("spinning_body", {});
  const ResultPtr rigid = run_shipped(
      "spinning_body", {"bodies.block.model={rigid: {dimension: 3, mesh: {box: {lengths: [0.2, "
                        "0.1, 0.05], elements: "
                        "[4, 2, 1], origin: centre}}}}",
                        "bodies.block.integrator={rigid_motion: {step: 2.0e-6, mass: lumped}}"});
  ASSERT_TRUE(fe->completed() && rigid->completed());
  EXPECT_NEAR(rigid->masses[0], fe->masses[0], roundoff(10.0, fe->masses[0]));
  // 5000 steps round the elastic body's momenta in sums over 30 nodes; the rigid one keeps its own.
  for (const char* axis : {"x", "y", "z"}) {
    const std::string momentum = std::string("body.block.momentum.") + axis;
    const std::string angular = std::string("body.block.angular_momentum.") + axis;
    EXPECT_NEAR(rigid->measure(momentum), fe->measure(momentum), roundoff(5000.0, 100.0)) << axis;
    EXPECT_NEAR(rigid->measure(angular), fe->measure(angular), roundoff(5000.0, 5.0)) << axis;
  }
  EXPECT_GT(fe->measure("body.block.energy.stored"), 0.0);  // it did deform
}

/// A block that flies turning under gravity and a pull, in one rung.
ResultPtr thrown(const std::string& model, const std::string& integrator) {
  return run_solids(
      2.0e-3, 1.0e-4,
      {{.name = "block",
        .material = "linear_elastic: {youngs_modulus: 1.0e9, poissons_ratio: 0.3, density: 1000.0}",
        .integrator = integrator,
        .velocity = {1.0, 2.0, 3.0},
        .model = model,
        .field = "\"-y\", \"x\", \"0\"",
        .more = "    body_force: [0.0, 0.0, -9.81]\n"
                "    loads: {pull: {on: right, traction: [\"1.0e4 * t\", \"1.0e5 * y\", \"0\"]}}\n",
        .block = {{0.2, 0.1, 0.05}, {2, 2, 1}, "tet10"}}});
}

TEST(RigidRung, OfAThrownBodyHasItsMomentumAndStart) {
  // The same rule in time for total momentum, the trapezoidal one, and the same mass matrix: equal
  // impulses. What is not rigid in the fall of the elastic block has no part in it.
  const ResultPtr fe = thrown("fe", "newmark: {step: 1.0e-5, mass: consistent}");
  const ResultPtr rigid = thrown("rigid", "rigid_motion: {step: 1.0e-5}");
  ASSERT_TRUE(fe->completed() && rigid->completed());
  ASSERT_EQ(fe->rows.size(), rigid->rows.size());
  // Newmark's equations are solved to 1e-9 of their forces, here to round-off: linear, 200 steps.
  for (const char* axis : {"x", "y", "z"}) {
    const std::string momentum = std::string("body.block.momentum.") + axis;
    EXPECT_NEAR(rigid->measure(momentum), fe->measure(momentum), roundoff(200.0 * 100.0, 3.0));
  }
  EXPECT_NEAR(rigid->rows[0].total[0], fe->rows[0].total[0], roundoff(200.0, fe->rows[0].total[0]));
}

}  // namespace
}  // namespace abut::rigid_rung_tests
