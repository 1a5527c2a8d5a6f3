// Goal: bars of the bars' own core move under loads as waves do, and press with what they carry.
// Oracle: d'Alembert's solutions of the wave equation.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/scenes.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::bars_under_load_tests {
namespace {

constexpr int elements = 50;

/// Length 50 m, wave speed and impedance 1, fixed on the left, seen at its free right end.
std::unique_ptr<Subdomain> bar(const std::string& integrator, const std::string& loads) {
  BarText text = unit_bar("bar", elements, elements, integrator);
  text.layer = "massless: {stiffness_factor: 1.0}";
  text.fixed = "left";
  text.more = "    loads: {" + loads + "}\n";
  return build(text);
}

/// Largest difference of the port's motion from a formula, over its largest size.
template <class Formula>
double error_of(Subdomain& body, double until, const Formula& exact) {
  Response response;
  const Outcome outcome = body.advance(free_request(body, 0.0, until), response);
  EXPECT_TRUE(std::holds_alternative<Advanced>(outcome));
  const Waveform& trace = response.ports[0].trace;
  double worst = 0.0, most = 0.0;
  for (std::size_t i = 0; i < trace.time.size(); ++i) {
    const double u = exact(trace.time[i]);
    worst = std::max(worst, std::abs(trace.u[i] - u));
    most = std::max(most, std::abs(u));
  }
  return worst / most;
}

std::vector<std::string> schemes() {
  return {explicit_scheme(0.6), explicit_scheme(0.6, 6), implicit_scheme("newmark", 0.6),
          implicit_scheme("hht_alpha", 0.6), implicit_scheme("generalized_alpha", 0.6)};
}

TEST(LoadedBars, SwingUnderTheirOwnAccelerationAsWavesHaveIt) {
  // The support's reflection reaches the free end at L/c and counts twice there.
  const double g = 0.01, transit = elements;
  const auto exact = [=](double t) {
    const double late = std::max(0.0, t - transit);
    return 0.5 * g * t * t - g * late * late;
  };
  for (const std::string& scheme : schemes()) {
    const std::unique_ptr<Subdomain> body = bar(scheme, "weight: {acceleration: ['0.01']}");
    ASSERT_TRUE(body->describe().model.starts_with("bar"));
    // A front of acceleration: errors of second order in 1/50, of the massless port in its element
    EXPECT_LT(error_of(*body, 2.8 * transit, exact), 2.0e-3) << scheme;
  }
}

TEST(LoadedBars, AreMovedByATractionAtItOverTheirImpedance) {
  // v = p A / Z until the reflection is back; then it turns around.
  const auto exact = [](double t) {
    const double round = 2.0 * elements;
    return t <= round ? 0.2 * t : 0.2 * (2.0 * round - t);
  };
  for (const std::string& scheme : schemes()) {
    const std::unique_ptr<Subdomain> body = bar(scheme, "pull: {on: right, traction: ['0.2']}");
    // The massless port stands one element's compliance away, 1/50 of a transit and half of that
    // of the largest place.
    EXPECT_LT(error_of(*body, 3.9 * elements, exact), 2.0e-2) << scheme;
  }
}

TEST(LoadedBars, ThatPullTheirContactNodeStretchItsElementByItsCompliance) {
  for (const std::string& scheme : schemes()) {
    const std::unique_ptr<Subdomain> body = bar(scheme, "pull: {on: right, traction: ['0.2']}");
    Response response;
    (void)body->advance(free_request(*body, 0.0, 0.0), response);
    const PortKernel kernel = body->probe({0, {1.0}, 0.6, 1});
    const double exact = 0.2 * kernel.compliance.at(0);
    EXPECT_NEAR(response.ports[0].trace.u[0], exact, roundoff(10.0, 0.2)) << scheme;
    EXPECT_NEAR(exact, 0.2, 0.01);  // F h / (E A), and a little less of the corrected operator
  }
}

/// Reaction of a wall at the right end of a free bar that p(t) pushes on the left: it comes after
/// L/c, twice, and every 2 L/c once more with the other sign.
TEST(LoadedBars, PressOnAWallWithTwiceThePressureThatArrives) {
  const double transit = elements, ramp = 6.0 * transit;
  const auto pressure = [ramp](double t) {
    const double s = std::clamp(t / ramp, 0.0, 1.0);
    return 0.1 * (1.0 - std::cos(M_PI * s));
  };
  const std::string text = fmt::format(
      "push: {{on: left, pressure: '0.1 * (1 - cos(pi * (t < {0} ? t / {0} : 1)))'}}", ramp);
  for (const std::string& scheme : schemes()) {
    BarText bar = unit_bar("bar", elements, elements, scheme);
    bar.more = "    loads: {" + text + "}\n";
    const std::unique_ptr<Subdomain> body = build(bar);
    PortGeometry wall = body->describe().ports[0].geometry;
    wall.normals[0] = -1.0;
    body->meet({0, 0, &wall});
    Advance request = free_request(*body, 0.0, 12.0 * transit);
    Obstacle& obstacle = request.boundary[0].obstacles.emplace_back();
    obstacle.motion.time = {0.0, 12.0 * transit};
    obstacle.motion.u = {0.0, 0.0};
    Response response;
    ASSERT_TRUE(std::holds_alternative<Advanced>(body->advance(request, response)));
    const Waveform& force = response.ports[0].reactions[0].force;
    double worst = 0.0;
    for (std::size_t i = 0; i < force.time.size(); ++i) {
      double exact = 0.0, sign = 2.0;
      for (double t = force.time[i] - transit; t > 0.0; t -= 2.0 * transit, sign = -sign)
        exact += sign * pressure(t);
      worst = std::max(worst, std::abs(force.f[i] - exact));
    }
    // Of 0.2: what is smooth over six transits of 50 elements
    EXPECT_LT(worst, 2.0e-3) << scheme;
    // The ramp has no part of the bar's frequencies: it comes to rest, compressed by 0.2.
    const Energy& energy = response.records.back().energy;
    EXPECT_LT(energy.kinetic, std::pow(2.0e-3 / 0.2, 2) * energy.stored) << scheme;
    EXPECT_NEAR(force.f.back(), 0.2, 2.0e-3) << scheme;
    EXPECT_NEAR(energy.stored, 0.5 * 0.2 * 0.2 * elements, 0.02) << scheme;
  }
}

}  // namespace
}  // namespace abut::bars_under_load_tests
