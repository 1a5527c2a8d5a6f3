// Goal: variants of shipped collisions give the figures that the method promises for them.
// Oracle: the closed form of the impact, and the figures published for the published form. Shipped
// scenes as they are: tests/system/test_figures.py.

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::collision_variants_tests {
namespace {

TEST(TwoBars, AtCflOneAreExactForAnyGapAndWindow) {
  const std::string path = std::string(ABUT_SOURCE_DIR) + "/configs/two_bars_cfl1.yaml";
  for (double shift : {0.0, 1.0e-3, 0.0123456}) {
    for (const char* window : {"1.25e-6", "1.25e-5", "1.25e-4"}) {
      const std::vector<std::string> overrides = {
          fmt::format("bodies.right.initial.position=[{}]", number(0.02 + shift)),
          std::string("time.window=") + window, "output.records_per_window=1"};
      const ResultPtr r = run_file(path, overrides);
      ASSERT_TRUE(r->completed());
      EXPECT_NEAR(r->measure("contact.impact.duration") / 5.0e-4, 1.0,
                  roundoff(400.0, 1.0))  // sums of 400 steps
          << shift << " " << window;
      EXPECT_EQ(r->measure("contact.impact.count"), 1.0);
      EXPECT_LE(r->measure("schwarz.iterations_max"), 2.0);
    }
  }
}

// The published form: figures of the publication's own method (method notes, section 2), I-I with
// lumped mass. Single chatter contacts at release move the second digit of some.

ResultPtr run_paper(const std::string& left, const std::string& right) {
  SceneText scene = two_bars();
  scene.window = 1.0e-7;
  scene.bars[0].integrator = left;
  scene.bars[1].integrator = right;
  for (BarText& bar : scene.bars) bar.layer = "massive: {}";
  scene.transmission = "dirichlet_neumann: {dirichlet: left.right}";
  scene.schwarz = "accelerator: {none: {}}, max_iterations: 128, tolerance: 1.0e-9";
  return run(scene);
}

TEST(PublishedForm, ImplicitBarsWithLumpedMassChatterAsPublished) {
  const std::string lumped = "newmark: {step: 1.0e-7, mass: lumped}";
  const ResultPtr r = run_paper(lumped, lumped);
  ASSERT_TRUE(r->completed());
  EXPECT_NEAR(r->measure("contact.first.force_rms_error"), 0.272, 0.0272);  // 10 %
  EXPECT_NEAR(r->measure("energy.total.relative_drift_max"), 1.25e-3, 1.25e-3 * 0.2);
  // 4.97 with the published norm of positions at 1e-12; ours is of the interface
  EXPECT_GE(r->measure("schwarz.iterations_max"), 4.0);
  EXPECT_LE(r->measure("schwarz.iterations_max"), 7.0);
}

}  // namespace
}  // namespace abut::collision_variants_tests
