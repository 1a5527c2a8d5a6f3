// Goal: a body that cannot be is refused with the reason, the number and what to do.
// Oracle: the words of the message.

#include <string>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "tests/support/refusal.hpp"
#include "tests/unit/solver_cases.hpp"

namespace abut::solver_refusals_tests {
namespace {

std::string refusal(const BarText& bar) {
  return abut::refusal([&bar] { build(bar); });
}

BarText plain() { return case_bar({"plain", explicit_scheme(0.6), "massless: {}", {"right"}}); }

TEST(MakeBody, RefusesAStepAboveTheLimitAndSaysTheLimit) {
  BarText bar = plain();
  bar.layer = "kick: {}";
  bar.integrator = explicit_scheme(1.01);
  expect_words(refusal(bar),
               {"bodies.bar.integrator.central_difference.step", "1.01", "limit of 1 s"});
  bar.integrator = explicit_scheme(1.0);  // CFL 1 is meant
  EXPECT_NO_THROW(build(bar));
}

TEST(MakeBody, RefusesTermsThatDoNotFit) {
  BarText bar = plain();
  bar.integrator = explicit_scheme(0.6, 30);
  expect_words(refusal(bar), {"dispersion_terms", "62 elements"});
}

TEST(MakeBody, RefusesKicksOfImplicitBodies) {
  BarText bar = plain();
  bar.integrator = implicit_scheme("newmark", 0.6);
  bar.layer = "kick: {}";
  expect_words(refusal(bar), {"contact_layer", "implicit", "massless"});
}

TEST(MakeBody, RefusesAPortAtAFixedEnd) {
  BarText bar = plain();
  bar.fixed = "right";
  expect_words(refusal(bar), {"supports.right", "port"});
}

TEST(MakeBody, RefusesOneElementBetweenTwoMasslessEnds) {
  BarText bar = plain();
  bar.sides = {"left", "right"};
  bar.elements = 1;
  expect_words(refusal(bar), {"elements", "at least 2"});
}

TEST(MakeBody, RefusesASideThatDoesNotExist) {
  BarText bar = plain();
  bar.sides = {"top"};
  expect_words(refusal(bar), {"ports.top.side", "'top'", "left or right"});
}

TEST(MakeBody, RefusesNumbersThatCannotBe) {
  BarText bar = plain();
  bar.density = -1.0;
  expect_words(refusal(bar), {"density", "positive"});
  bar = plain();
  bar.length = 0.0;
  expect_words(refusal(bar), {"length", "positive"});
  bar = plain();
  bar.elements = 0;
  expect_words(refusal(bar), {"elements"});
  bar = plain();
  bar.integrator = "newmark: {step: 0.6, beta: 0.25, gamma: 0.6}";
  expect_words(refusal(bar), {"beta", "gamma/2"});
}

TEST(MakeBody, DescribesItself) {
  const std::unique_ptr<Subdomain> body = build(plain());
  const Description& d = body->describe();
  EXPECT_EQ(d.name, "bar");
  EXPECT_EQ(d.step, 0.6);
  EXPECT_EQ(d.dofs, 41);
  EXPECT_EQ(d.mass, 40.0);
  EXPECT_EQ(d.ports.at(0).geometry.points.at(0), 40.0);
  EXPECT_EQ(d.ports.at(0).geometry.normals.at(0), 1.0);
  EXPECT_TRUE(d.can.obstacle && d.can.force && d.can.kernel && d.can.yielding);
  EXPECT_FALSE(d.can.motion);
  BarText massive = plain();
  massive.layer = "massive: {}";
  const Capabilities can = build(massive)->describe().can;
  EXPECT_TRUE(can.motion && can.force);
  EXPECT_FALSE(can.obstacle || can.yielding || can.kernel);
}

}  // namespace
}  // namespace abut::solver_refusals_tests
