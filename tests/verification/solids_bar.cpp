// Goal: bars by the model of solids converge in space and time. Oracles: d'Alembert's waves; the
// hanging bar of Hencky's law, P = E ln(s)/s, by Simpson's rule.
#include <cmath>

#include "subdomain_solver/materials/hencky.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/time/explicit_dynamics.hpp"
#include "tests/support/solid_runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::solids_bar_tests {
namespace {

FeOptions of_area(double area) {
  FeOptions options;
  options.area = area;
  return options;
}

/// Error of a Gaussian pulse after it has parted in two, over its height. Wave speed 1000 m/s.
double wave_error(int elements, bool explicit_in_time) {
  const double c = 1000.0, width = 0.04, end = 2.0e-4, h = 1.0 / elements;
  Solid s(generate(BarMesh{-0.5, 1.0, elements}, "test"),
          std::make_unique<LinearElastic>(isotropic(1.0e9, 0.3), 1000.0), of_area(1.0e-6));
  s.fix("left", 0);
  s.fix("right", 0);
  const auto f = [width](double x) { return 1.0e-3 * std::exp(-0.5 * x * x / (width * width)); };
  s.motion.q =
      nodal(s.model.mesh(), [&f](const Position& x) { return Position(f(x.x()), 0.0, 0.0); });
  const int steps = static_cast<int>(std::lround(end * c / (0.5 * h)));
  ExplicitDynamics central(s.problem);
  ImplicitDynamics trapezoidal(s.problem, {}, make_direct_solver());
  Integrator& run = explicit_in_time ? static_cast<Integrator&>(central) : trapezoidal;
  EXPECT_FALSE(run.begin(s.motion, 0.0));
  for (int k = 0; k < steps; ++k)
    EXPECT_FALSE(run.step(s.motion, k * (end / steps), end / steps)) << "step " << k;
  double most = 0.0;
  for (int node = 0; node < s.model.mesh().node_count(); ++node) {
    const double x = position(s.model.mesh(), node).x();
    const double exact = 0.5 * (f(x - c * end) + f(x + c * end));
    most = std::max(most, std::abs(s.displacement(node).x() - exact));
  }
  return most / 1.0e-3;
}

TEST(BarWave, ConvergesToDAlembertInSpaceAndTime) {
  for (const bool explicit_in_time : {true, false}) {
    const double coarse = wave_error(200, explicit_in_time);
    const double fine = wave_error(400, explicit_in_time);
    // Terms of next order are (h/width)^2 = 1.6 % of the error, times a few units.
    EXPECT_NEAR(observed_order(coarse, fine), 2.0, 0.1) << explicit_in_time;
    EXPECT_LT(fine, 2.0e-3) << explicit_in_time;
  }
}

/// Stretch at a stress P of Hencky's law with Young's modulus 1, by Newton's method.
double stretch(double p) {
  double s = 1.0 + p;
  for (int k = 0; k < 50; ++k) s -= (std::log(s) / s - p) / ((1.0 - std::log(s)) / (s * s));
  return s;
}

/// Displacement of the tip of a bar of length 1 under its weight of 0.25 per length.
double hanging_tip(int elements) {
  Solid s(generate(BarMesh{0.0, 1.0, elements}, "test"),
          std::make_unique<Hencky>(isotropic(1.0, 0.3), 1.0), of_area(0.7));
  s.fix("left", 0);
  s.problem.loads.push_back(std::make_unique<BodyForce>(
      s.model, VectorField{[](const auto&, double time) { return 0.25 * time; }, {}, {}}));
  NewtonOptions newton;
  newton.tolerance = 1.0e-12;
  s.settle(4, newton);
  return s.mean_displacement("right").x();
}

TEST(HangingBar, ConvergesToTheLawsOwnIntegral) {
  double exact = 0.0;
  const int n = 1000;
  for (int k = 0; k <= n; ++k) {
    const double weight = k == 0 || k == n ? 1.0 : k % 2 == 1 ? 4.0 : 2.0;
    exact += weight * (stretch(0.25 * (1.0 - double(k) / n)) - 1.0) / (3.0 * n);
  }
  const double coarse = hanging_tip(16) - exact, fine = hanging_tip(32) - exact;
  EXPECT_GT(exact, 0.1);  // far beyond small strain
  // A midpoint rule; terms of next order are of the size of 1/16^2.
  EXPECT_NEAR(observed_order(coarse, fine), 2.0, 0.05);
}

}  // namespace
}  // namespace abut::solids_bar_tests
