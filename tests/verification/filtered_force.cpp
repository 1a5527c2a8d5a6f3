// Goal: a filtered peak of the contact force converges when the mesh is refined, and says what the
// peak itself, and a mean over an element's transit, cannot.
// Oracle: the exact force of two equal bars, 100 N for 5e-4 s, behind the same filters: its mean is
// 100 N; a channel frequency class makes 1 - exp(-ad/2) cos(ad/2) of it, a = wd / sqrt 2.
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::filtered_force_tests {
namespace {

constexpr double exact = 100.0;      // [N]
constexpr double duration = 5.0e-4;  // [s]
const std::array<int, 3> meshes = {100, 200, 400};

double transit(int elements) { return duration / (2.0 * elements); }  // [s] h/c

struct Peaks {
  double plain, filtered;  // [N]
};

/// The shipped collision on another mesh, at the same ratio of step and stable step.
Peaks peaks(int elements, int terms, const std::string& filter) {
  std::vector<std::string> overrides = {"output.force_filter={" + filter + "}"};
  for (const std::string bar : {"bodies.left.", "bodies.right."}) {
    overrides.push_back(fmt::format("{}model.fe.mesh.bar.elements={}", bar, elements));
    overrides.push_back(
        fmt::format("{}integrator.central_difference.step={:.3e}", bar, 0.08 * transit(elements)));
    overrides.push_back(
        fmt::format("{}integrator.central_difference.dispersion_terms={}", bar, terms));
  }
  const ResultPtr r = run_file(std::string(ABUT_SOURCE_DIR) + "/configs/two_bars.yaml", overrides);
  EXPECT_TRUE(r->completed());
  return {r->measure("contact.impact.force_peak"),
          r->measure("contact.impact.force_peak_filtered")};
}

class FilteredForce : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(DispersionTerms, FilteredForce, testing::Values(1, 6));

TEST_P(FilteredForce, MeanOverAFixedTimeConvergesAndThePeakDoesNot) {
  std::vector<double> errors;
  for (const int elements : meshes) {
    const Peaks p = peaks(elements, GetParam(), "mean: {time: 1.0e-5}");
    // Measured 1.53 and 1.51 on every mesh: the front's shape is one of transits.
    EXPECT_NEAR(p.plain / exact, 1.52, 0.03) << elements;
    errors.push_back(p.filtered / exact - 1.0);
  }
  // What the front's overshoot holds is 0.65 of a transit's impulse: the first power of the
  // element. Measured orders are 1.02 to 1.06.
  for (std::size_t k = 1; k < errors.size(); ++k)
    EXPECT_NEAR(observed_order(errors[k - 1], errors[k]), 1.0, 0.15);
  // To an eighth, as the orders are.
  EXPECT_NEAR(errors.back(), 0.65 * transit(meshes.back()) / 1.0e-5, 0.01);
}

TEST_P(FilteredForce, ChannelClassConvergesToTheFilteredExactForce) {
  for (const int of_class : {600, 1000}) {
    const double wd = 2.0 * std::numbers::pi * 2.0775 * of_class;
    // a d / 2: below pi the pulse is largest in its middle
    const double half = 0.5 * duration * wd / std::numbers::sqrt2;
    const double expected = exact * (1.0 - std::exp(-half) * std::cos(half));
    std::vector<double> errors;
    for (const int elements : meshes) {
      const Peaks p = peaks(elements, GetParam(), fmt::format("cfc: {{class: {}}}", of_class));
      errors.push_back(std::abs(p.filtered / expected - 1.0));
    }
    // Of a filter longer than the pulse it is the error of the impulse. Measured from 100 to 400
    // elements: class 600 3.0e-3 to 1.2e-3 and 3.6e-4 to 1.2e-4, class 1000 1.7e-4 to 5.4e-5 and
    // 1.6e-5 to 6e-7, with one term and six. Samples at 1000 times the class are good for 1e-5.
    EXPECT_LT(errors.back(), 1.5e-3) << of_class;
    EXPECT_LT(errors.back(), 0.5 * errors.front() + 1.0e-5) << of_class;  // of samples
  }
}

TEST_P(FilteredForce, MeanOverATransitKeepsTheOvershootOnEveryMesh) {
  for (const int elements : meshes) {
    const Peaks p =
        peaks(elements, GetParam(), fmt::format("mean: {{time: {:.6e}}}", transit(elements)));
    EXPECT_NEAR(p.filtered / exact, 1.48, 0.03) << elements;  // measured 1.498 and 1.467
  }
}

}  // namespace
}  // namespace abut::filtered_force_tests
