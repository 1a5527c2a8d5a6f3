// Goal: errors of the impact fall with the mesh as fast as a discontinuous solution allows.
// Oracle: the closed form over meshes of 25 to 200 elements, steps of CFL 0.08 on all of them.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::convergence_tests {
namespace {

const std::vector<int> meshes = {25, 50, 100, 200};

struct Errors {
  std::vector<double> release, energy, velocity;  // by mesh, relative
};

Errors errors_of(const std::string& layer, const std::string& scheme, int terms) {
  Errors errors;
  for (int elements : meshes) {
    SceneText scene = two_bars();
    const double step = 1.0e-7 * 200 / elements;
    scene.window = 10.0 * step;
    for (BarText& bar : scene.bars) {
      bar.elements = elements;
      bar.layer = layer;
      bar.integrator =
          scheme == "explicit" ? explicit_scheme(step, terms) : implicit_scheme(scheme, step);
    }
    scene.end = scene.begin + scene.window * std::round(1.0e-3 / scene.window);
    const ResultPtr r = run(scene);
    EXPECT_TRUE(r->completed());
    EXPECT_EQ(r->measure("contact.first.count"), 1.0) << elements;
    errors.release.push_back(std::abs(r->measure("contact.first.release_error")));
    errors.energy.push_back(std::abs(r->measure("energy.total.relative_drift_max")));
    errors.velocity.push_back(std::abs(r->velocity(0) / 100.0 + 1.0));
  }
  return errors;
}

void expect_orders(const std::vector<double>& errors, double order, double slack) {
  for (std::size_t i = 1; i < errors.size(); ++i)
    EXPECT_NEAR(observed_order(errors[i - 1], errors[i]), order, slack)
        << meshes[i] << " elements: " << errors[i - 1] << " to " << errors[i];
}

TEST(Convergence, ReleaseOfPlainKicksFallsAsTheDispersedFront) {
  // The front widens as N^(1/3) cells: N^(-2/3); 1.41, 0.91, 0.59 and 0.37 % are published.
  const Errors e = errors_of("kick: {}", "explicit", 1);
  expect_orders(e.release, 2.0 / 3.0, 0.1);
  EXPECT_NEAR(e.release.back(), 3.70e-3, 0.05e-3);
  EXPECT_NEAR(e.release.front(), 1.41e-2, 0.03e-2);
}

TEST(Convergence, TheHalfCellThatKicksCaptureHalvesWithTheMesh) {
  const Errors e = errors_of("kick: {}", "explicit", 1);
  expect_orders(e.energy, 1.0, 0.1);
  EXPECT_NEAR(e.energy.back(), 1.0 / 400, 1.0 / 4000);  // 1 / (2 N)
}

TEST(Convergence, MasslessLayersKeepEnergyOnEveryMesh) {
  const Errors e = errors_of("massless: {stiffness_factor: 1.0}", "explicit", 1);
  for (double energy : e.energy) EXPECT_NEAR(energy, 0.0, iteration(1.0e-6));
  // 2.0, 1.2, 0.68, 0.41 % are published: between the orders of the front and of the cell
  expect_orders(e.release, 0.75, 0.12);
  EXPECT_NEAR(e.release.back(), 4.09e-3, 0.05e-3);
}

TEST(Convergence, DispersionTermsRestoreTheFirstOrder) {
  const Errors e = errors_of("massless: {stiffness_factor: 1.0}", "explicit", 6);
  expect_orders(e.release, 1.0, 0.1);  // 1.1, 0.56, 0.28, 0.14 % are published
  EXPECT_NEAR(e.release.back(), 1.40e-3, 0.03e-3);
  for (std::size_t i = 1; i < e.velocity.size(); ++i) EXPECT_LT(e.velocity[i], e.velocity[i - 1]);
}

TEST(Convergence, SixTermsWithKicksReachTheirPublishedRelease) {
  const Errors e = errors_of("kick: {}", "explicit", 6);
  // published with steps of CFL 0.01: 0.043, 0.025, 0.014 % at 50, 100 and 200 elements
  const std::vector<double> published = {4.3e-4, 2.5e-4, 1.4e-4};
  for (std::size_t i = 0; i < published.size(); ++i)
    EXPECT_NEAR(e.release[i + 1], published[i], 0.1 * published[i]) << meshes[i + 1];
  expect_orders(e.release, 0.8, 0.1);
}

TEST(Convergence, CalibratedLayersAreBelowAThirtiethOfAPerCentOnEveryMesh) {
  const Errors e = errors_of("massless: {stiffness_factor: 1.4}", "explicit", 6);
  // published: 0.029, 0.010 and 0.0022 % at 50, 100 and 200 elements
  EXPECT_NEAR(e.release[1], 2.9e-4, 0.3e-4);
  EXPECT_NEAR(e.release[2], 1.0e-4, 0.1e-4);
  EXPECT_NEAR(e.release[3], 2.2e-5, 0.2e-5);
}

TEST(Convergence, ImplicitBarsConverge) {
  const Errors e = errors_of("massless: {}", "newmark", 1);
  for (std::size_t i = 1; i < meshes.size(); ++i) {
    EXPECT_LT(e.release[i], e.release[i - 1]);
    EXPECT_LT(e.velocity[i], e.velocity[i - 1]);
  }
  for (double energy : e.energy) EXPECT_NEAR(energy, 0.0, iteration(1.0e-6));
}

}  // namespace
}  // namespace abut::convergence_tests
