// Goal: the conventional contact methods have their published figures for the published reasons.
// Oracles: the mechanics of a penalty spring, the energy of a contact cell, equality over windows.
// The figures themselves are held by the scenes (tests/system/test_scenes.py).

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"

namespace abut::conventional_methods_tests {
namespace {

std::string path_of(const std::string& scene) {
  return std::string(ABUT_SOURCE_DIR) + "/configs/methods/" + scene + ".yaml";
}

class Conventional : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(
    Methods, Conventional,
    testing::Values("penalty_explicit", "penalty_implicit", "lagrange_explicit",
                    "lagrange_implicit", "lagrange_implicit_backward_euler",
                    "lagrange_implicit_trapezoidal", "penalty_explicit_current_lengths",
                    "lagrange_explicit_current_lengths", "lagrange_implicit_current_lengths"));

TEST_P(Conventional, DoesNotDependOnTheWindow) {
  const ResultPtr one = run_file(path_of(GetParam()), {"time.window=1.0e-7"});
  const ResultPtr many = run_file(path_of(GetParam()), {"time.window=1.0e-5"});
  EXPECT_EQ(one->rows.back().total, many->rows.back().total);
  EXPECT_EQ(one->rows.back().u, many->rows.back().u);
  EXPECT_EQ(one->measure("contact.impact.count"), many->measure("contact.impact.count"));
  // a window shows at least two forces before the release, or it is located to one step of 1e-7 s
  EXPECT_NEAR(one->measure("contact.impact.end"), many->measure("contact.impact.end"), 1.001e-7);
  EXPECT_NEAR(one->measure("contact.impact.begin"), many->measure("contact.impact.begin"),
              1.001e-7);
}

TEST(ConventionalMethods, PenaltyOverlapFollowsTheSpringAndVanishesWithIt) {
  // A stiff spring overshoots at first touch: 141 N at 7.5e5 N/m. The overlap follows the force.
  for (double stiffness : {7.5e4, 7.5e5}) {
    const std::string spring =
        fmt::format("bodies.pair.model.bar_pair.contact.penalty.stiffness={}", stiffness);
    const ResultPtr r = run_file(path_of("penalty_explicit"), {spring});
    // gaps are known at the ends of windows only, every tenth step: the peak is flat to 2 % there
    const double overlap = r->measure("contact.impact.force_peak") / stiffness;
    EXPECT_NEAR(-r->measure("contact.impact.gap_min"), overlap, 0.02 * overlap);
    EXPECT_GT(overlap, 100.0 / stiffness) << "F / tau, F = 100 N";
  }
}

TEST(ConventionalMethods, ExplicitMultiplierLosesTheEnergyOfTheContactCells) {
  for (int elements : {50, 100}) {
    const std::string n = std::to_string(elements);
    const ResultPtr r =
        run_file(path_of("lagrange_explicit"), {"bodies.pair.model.bar_pair.left.elements=" + n,
                                                "bodies.pair.model.bar_pair.right.elements=" + n});
    const double expected = -1.0 / (2.0 * elements);
    // 2 %: the release loses a little more or less than the impact
    EXPECT_NEAR(r->measure("energy.total.relative_drift_end"), expected, 0.02 * -expected);
  }
}

TEST(ConventionalMethods, APairIsWatchedAndItsPortsTakeNoOtherTransmission) {
  try {
    run_file(path_of("penalty_explicit"), {"interfaces.impact.transmission={unilateral: {}}"});
    FAIL() << "accepted";
  } catch (const InputError& refused) {
    EXPECT_NE(std::string(refused.what()).find("two different bodies"), std::string::npos);
  }
}

}  // namespace
}  // namespace abut::conventional_methods_tests
