// Goal: where more points are pressed passively than a body can tell the whole compliance of, the
// bound by its mass leads to the same: no energy is made, momentum stays, plates part. Oracle:
// equal plates that meet flat exchange their velocities.

#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::passive_many_points_tests {
namespace {

/// Plates of 29 by 29 points, more than two thousand values, whose surfaces have mass.
std::string plates(const std::string& law, const std::string& integrator,
                   const std::string& contact) {
  return fmt::format(R"(units: SI
time: {{end: 1.6e-4, window: 1.0e-5}}
bodies:
  a:
    model: {{fe: {{dimension: 3, mesh: {{box: {{lengths: [1, 0.05, 1], elements: [28, 2, 28]}}}}}}}}
    material: {{{}: {{youngs_modulus: 1.0e9, poissons_ratio: 0.0, density: 1000.0}}}}
    integrator: {{{}}}
    initial: {{position: [0, 0.0001, 0], velocity: [0, -5, 0]}}
    contact_layer: massive
    ports: {{t: bottom}}
  b:
    like: a
    initial: {{position: [0, -0.05, 0], velocity: [0, 0, 0]}}
    ports: {{t: top}}
interfaces: {{i: {{sides: [a.t, b.t], contact: {{{}}}}}}}
)",
                     law, integrator, contact);
}

TEST(PassiveManyPoints, PlatesExchangeTheirVelocities) {
  struct Case {
    const char *law, *integrator, *contact;
  };
  for (const Case& c :
       {Case{"linear_elastic", "central_difference: {step: 1.0e-5}", ""},
        Case{"linear_elastic", "newmark: {step: 1.0e-5}", ""},
        Case{"saint_venant_kirchhoff", "central_difference: {step: 1.0e-5}", "friction: 0.3"}}) {
    SCOPED_TRACE(fmt::format("{} {} {}", c.law, c.integrator, c.contact));
    const auto run = run_text(plates(c.law, c.integrator, c.contact));
    ASSERT_TRUE(run->completed()) << run->end.reason;
    const GivenUp& up = run->end.given_up;
    ASSERT_GT(up.windows, 5);
    const double momentum = -250.0;  // [kg m/s] of 50 kg
    const double a = run->measure("body.a.momentum.y"), b = run->measure("body.b.momentum.y");
    EXPECT_NEAR(a + b, momentum, roundoff(1000.0, momentum));
    // Nodes that meet lose what moves them, h/2L of the energy or half of that of the velocity.
    EXPECT_NEAR(b, momentum, 0.15 * 250.0);
    double energy = 0.0;
    for (const char* body : {"a", "b"})
      for (const char* of : {"kinetic", "stored", "dissipated"})
        energy += run->measure(fmt::format("body.{}.energy.{}", body, of));
    const double begin = 625.0, told = up.joules() + up.friction;
    EXPECT_LE(energy, begin);
    // Newton's method leaves a part in a thousand of what a step changes at finite strain.
    EXPECT_NEAR(energy + told, begin, 1.0e-3 * begin);
    EXPECT_TRUE(run->end.overlaps.empty());
  }
}

}  // namespace
}  // namespace abut::passive_many_points_tests
