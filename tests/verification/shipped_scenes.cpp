// Goal: every shipped scene gives the figures that the method promises for it.
// Oracle: the closed form of the impact, and the figures published for the published form. The
// bounds are goals, stated apart from the scenes' own expectations, so that loosening a scene is
// seen here.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "coordinator/record/expectations.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut {
namespace {

using ResultPtr = std::unique_ptr<RunResult>;

std::string path_of(const std::string& name) {
  return std::string(ABUT_SOURCE_DIR) + "/configs/" + name + ".yaml";
}

ResultPtr run_shipped(const std::string& name) { return run_file(path_of(name)); }

double duration_of(const RunResult& r) { return r.measure("contact.impact.duration"); }

class ShippedScene : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Verification, ShippedScene,
                         testing::Values("two_bars", "two_bars_step_windows", "two_bars_implicit",
                                         "two_bars_implicit_explicit", "two_bars_cfl1",
                                         "two_bars_parallel", "two_bars_paper", "unequal_bars",
                                         "rigid_wall", "bars/tied_halves"));

TEST_P(ShippedScene, MeetsItsOwnExpectations) {
  const Document document = Document::load(path_of(GetParam()));
  const ResultPtr r = run_document(document);
  ASSERT_TRUE(r->completed());
  const std::vector<ExpectationResult> results =
      evaluate(read_scene(document).meta.expect, r->measures);
  EXPECT_FALSE(results.empty());
  for (const ExpectationResult& e : results) EXPECT_TRUE(e.pass) << e.measure << " is " << e.got;
}

TEST(TwoBars, ContactLastsOneWaveTransit) {
  const ResultPtr r = run_shipped("two_bars");
  EXPECT_NEAR(r->measure("contact.impact.begin"), 0.0, roundoff(1000, 2e-4));
  EXPECT_NEAR(duration_of(*r), 5.0e-4, 5.0e-4 * 5.0e-4);  // goal: 0.05 %
  // published: the impulse of this layer is 0.051 % short, which is left in vibration
  EXPECT_NEAR(r->measure("contact.impact.impulse"), 0.05 * (1.0 - 5.1e-4), 0.05 * 1.0e-5);
  EXPECT_NEAR(r->measure("contact.impact.force_mean") * duration_of(*r),
              r->measure("contact.impact.impulse"), roundoff(1000, 0.05));
  EXPECT_LT(r->measure("contact.impact.force_rms_error"), 5.0e-4);
}

TEST(TwoBars, EnergyAndMomentumStay) {
  const ResultPtr r = run_shipped("two_bars");
  EXPECT_LT(r->measure("energy.total.relative_drift_max"), 2.0e-5);  // goal: 0.002 %
  EXPECT_LT(r->momentum_error(), roundoff(1000, 1.0));
}

TEST(TwoBars, NeedTwoIterationsAndFewExchanges) {
  const ResultPtr r = run_shipped("two_bars");
  EXPECT_LE(r->measure("schwarz.iterations_mean"), 2.0);
  EXPECT_LE(r->measure("schwarz.iterations_max"), 2.0);
  EXPECT_LE(r->measure("exchanges"), 400.0);
}

TEST(TwoBars, AtCflOneAreExact) {
  const ResultPtr r = run_shipped("two_bars_cfl1");
  constexpr double exact = 1.0e-10;  // goal: 1e-8 %
  EXPECT_NEAR(duration_of(*r) / 5.0e-4, 1.0, exact);
  EXPECT_NEAR(r->velocity(0), -100.0, 100.0 * exact);
  EXPECT_NEAR(r->velocity(1), 100.0, 100.0 * exact);
  EXPECT_NEAR(r->energy_error(), 0.0, exact);
  EXPECT_LT(r->measure("contact.impact.force_rms_error"), exact);
}

TEST(TwoBars, AtCflOneAreExactForAnyGapAndWindow) {
  for (double shift : {0.0, 1.0e-3, 0.0123456}) {
    for (const char* window : {"1.25e-6", "1.25e-5", "1.25e-4"}) {
      const std::vector<std::string> overrides = {
          fmt::format("bodies.right.initial.position=[{}]", number(0.02 + shift)),
          std::string("time.window=") + window, "output.records_per_window=1"};
      const ResultPtr r = run_file(path_of("two_bars_cfl1"), overrides);
      ASSERT_TRUE(r->completed());
      EXPECT_NEAR(duration_of(*r) / 5.0e-4, 1.0, 1.0e-9) << shift << " " << window;
      EXPECT_EQ(r->measure("contact.impact.count"), 1.0);
      EXPECT_LE(r->measure("schwarz.iterations_max"), 2.0);
    }
  }
}

TEST(TwoBars, ImplicitOnesKeepTheirEnergy) {
  for (const char* name : {"two_bars_implicit", "two_bars_implicit_explicit"}) {
    const ResultPtr r = run_shipped(name);
    EXPECT_LT(r->measure("energy.total.relative_drift_max"), 2.0e-5) << name;
    // averaged mass: 0.17 to 0.18 % is the published floor of a massless contact layer without
    // calibrated first spring, 0.04 % with 4/3
    EXPECT_LT(std::abs(r->measure("contact.impact.release_error")), 1.0e-3) << name;
    EXPECT_LE(r->measure("schwarz.iterations_max"), 2.0) << name;
  }
}

TEST(TwoBars, UnequalOnesPartWithTheClosedFormsVelocities) {
  const ResultPtr r = run_shipped("unequal_bars");
  // Impedances 1 and sqrt(6): both fronts return at their own times, the left one first (2 L / c
  // with c = 1000 m/s against 816 m/s), when contact ends. Momentum handed over is F x 2 L / c.
  const double z = std::sqrt(6.0), force = 200.0 * z / (1.0 + z);
  const double handed = force * 5.0e-4;
  EXPECT_NEAR(r->velocity(0), 100.0 - handed / 2.5e-4, 0.5);  // 0.2 % of the change of 284 m/s
  EXPECT_NEAR(r->velocity(1), -100.0 + handed / 7.5e-4, 0.2);
  EXPECT_NEAR(r->measure("contact.impact.force_mean"), force, force * 2e-3);
  EXPECT_LT(r->momentum_error(), roundoff(1000, 1.0));
}

TEST(RigidWall, IsTheMirror) {
  const ResultPtr wall = run_shipped("rigid_wall");
  const ResultPtr pair = run_shipped("two_bars");
  EXPECT_NEAR(duration_of(*wall), duration_of(*pair), 5.0e-4 * iteration(1e-6));
  EXPECT_NEAR(wall->velocity(0), pair->velocity(0), 100.0 * iteration(1e-6));
  EXPECT_EQ(wall->measure("schwarz.iterations_max"), 1.0);
}

// The published form: figures of the publication's own method (method notes, section 2), E-E, I-I
// and I-E with lumped mass. Single chatter contacts at release move the second digit of some.

TEST(PublishedForm, ExplicitBarsGiveTheirPublishedFigures) {
  const ResultPtr r = run_shipped("two_bars_paper");
  EXPECT_NEAR(r->measure("schwarz.iterations_mean"), 3.0, 0.05);
  EXPECT_EQ(r->measure("schwarz.iterations_max"), 3.0);
  EXPECT_NEAR(r->measure("energy.total.relative_drift_max"), 1.11e-3, 1.1e-4);
  EXPECT_NEAR(r->measure("contact.impact.force_rms_error"), 0.282, 0.0141);  // 5 %
  EXPECT_NEAR(r->measure("contact.impact.release_error_half_force"), 1.22e-3, 5e-4);
}

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
}  // namespace abut
