// Goal: Robin conditions lead to the same contact as the unilateral form, at the price in
// iterations that theory and experiment tell; the first relaxation factor by probe saves some.
// Oracle: the unilateral form with port kernels on the same bars.

#include <string>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::robin_tests {
namespace {

SceneText unequal(const std::string& layer, double window) {
  SceneText scene = two_bars();
  for (BarText& bar : scene.bars) {
    bar.layer = layer;
    bar.integrator = explicit_scheme(1.0e-7);
  }
  scene.bars[1].modulus *= 2.0;
  scene.bars[1].density *= 3.0;
  scene.window = window;
  scene.closed_form = false;
  return scene;
}

class RobinForm : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Coupling, RobinForm, testing::Values("alternating", "parallel"));

TEST_P(RobinForm, GivesTheContactOfTheUnilateralForm) {
  for (const char* layer : {"massless: {}", "kick: {}"}) {
    SceneText scene = unequal(layer, 1.0e-6);
    const ResultPtr kernel = run(scene);
    scene.transmission = "robin: {}";
    scene.schwarz =
        fmt::format("form: {}, accelerator: {{anderson: {{}}}}, max_iterations: 100", GetParam());
    const ResultPtr robin = run(scene);
    ASSERT_TRUE(robin->completed()) << layer;
    // tolerance 1e-6 of a step's motion in each of 500 windows
    for (std::size_t body : {0u, 1u})
      EXPECT_NEAR(robin->velocity(body), kernel->velocity(body), 100.0 * iteration(1e-6, 100));
    EXPECT_NEAR(robin->energy_error(), kernel->energy_error(), iteration(1e-6, 100)) << layer;
    EXPECT_LT(robin->momentum_error(), iteration(1e-6, 10)) << layer;
    EXPECT_EQ(robin->measure("contact.first.count"), 1.0) << layer;
  }
}

TEST(Robin, WithMatchedImpedanceIsNoCure) {
  SceneText scene = unequal("kick: {}", 1.0e-6);
  EXPECT_LE(run(scene)->measure("schwarz.iterations_max"), 2.0);
  scene.transmission = "robin: {impedance: matched}";
  scene.schwarz = "accelerator: {none: {}}, max_iterations: 100";
  const ResultPtr r = run(scene);
  ASSERT_TRUE(r->completed());
  EXPECT_GT(r->measure("schwarz.iterations_mean"), 5.0);  // published 10.7
}

TEST(Robin, WithTheKernelsImpedanceNeedsTwoIterationsInWindowsOfAStep) {
  SceneText scene = unequal("kick: {}", 1.0e-7);
  scene.transmission = "robin: {impedance: kernel}";
  scene.schwarz = "accelerator: {none: {}}, max_iterations: 100";
  EXPECT_LE(run(scene)->measure("schwarz.iterations_max"), 3.0);  // published 3
}

TEST(Robin, RefusesPortKernelsAsJacobian) {
  SceneText scene = unequal("kick: {}", 1.0e-6);
  scene.transmission = "robin: {}";
  EXPECT_THROW(run(scene), InputError);
}

TEST(ProbedFactor, IsExactInWindowsOfAStepAndBetterThanAHalfInLongerOnes) {
  SceneText scene = unequal("kick: {}", 1.0e-7);
  for (const char* accelerator :
       {"relaxation: {factor: probe}", "aitken: {}", "anderson: {reuse: 0}"}) {
    scene.window = 1.0e-7;
    scene.schwarz = fmt::format("accelerator: {{{}}}", accelerator);
    EXPECT_LE(run(scene)->measure("schwarz.iterations_max"), 2.0) << accelerator;
  }
  scene.window = 1.0e-6;
  scene.schwarz = "accelerator: {aitken: {}}";
  const double probed = run(scene)->measure("schwarz.iterations_mean");
  scene.schwarz = "accelerator: {aitken: {initial: 0.5}}";
  EXPECT_LT(probed, run(scene)->measure("schwarz.iterations_mean"));
}

}  // namespace
}  // namespace abut::robin_tests
