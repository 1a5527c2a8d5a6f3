// Goal: contact closes, opens, and is ruled out where geometry and forces say so. Oracles:
// hand-made traces.

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "coordinator/coupling/contact.hpp"
#include "coordinator/coupling/horizon.hpp"
#include "coordinator/coupling/unilateral.hpp"
#include "tests/support/scripted.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::coupling_criteria_tests {
namespace {

/// [s] Of contact that no kick layer has left yet.
constexpr double never_opened = -std::numeric_limits<double>::infinity();

TEST(Joints, KnowsItsGapAndOffsets) {
  const Facing m;
  EXPECT_EQ(m.joint.line.reference_gap, 1.0);
  EXPECT_EQ(m.joint.gap(0.25, -0.25), 0.5);
  EXPECT_EQ(m.joint.offset(0), 1.0);
  EXPECT_EQ(m.joint.offset(1), -1.0);
}

TEST(Joints, RefusesPortsThatLookTheSameWay) {
  Scripted a(0.0, 1.0, 1.0), b(1.0, 1.0, 1.0);
  const Bodies bodies({&a, &b});
  EXPECT_THROW(make_joint("i", {Side{0, 0}, Side{1, 0}}, bodies), InputError);
}

TEST(Joints, RefusesPortsOfSeveralPoints) {
  Scripted one(0.0, 1.0, 1.0), several(1.0, -1.0, 1.0);
  several.description_.ports[0].geometry.points = {1.0, 2.0};
  several.description_.ports[0].geometry.normals = {-1.0, -1.0};
  const Bodies bodies({&one, &several});
  EXPECT_THROW(make_joint("i", {Side{0, 0}, Side{1, 0}}, bodies), InputError);
}

TEST(Joints, RefusesSidesThatOverlapAtTheStart) {
  Scripted a(0.5, 1.0, 1.0), b(0.0, -1.0, 1.0);
  const Bodies bodies({&a, &b});
  try {
    make_joint("i", {Side{0, 0}, Side{1, 0}}, bodies);
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("0.5"), std::string::npos) << error.what();
  }
}

TEST(FirstOverlap, LocatesTheTouchOnTheFinerSide) {
  Facing m;
  m.left.trace({0, 1, 2, 3, 4}, {0.0, 0.25, 0.5, 0.75, 1.0});
  m.right.trace({0, 4}, {0.0, -1.0});  // closing at 0.5 m/s: the gap of 1 m is gone at 2
  m.reply();
  const std::optional<Touch> touch = first_overlap(m.joint, m.bodies, 0.0);
  ASSERT_TRUE(touch);
  EXPECT_EQ(touch->time, 2.0);
  EXPECT_EQ(touch->speed, 0.5);
  EXPECT_EQ(touch->state, 3.0);  // the first substep that overlaps ends there
}

TEST(FirstOverlap, InterpolatesWithinASubstep) {
  Facing m;
  m.left.trace({0, 1, 2}, {0.0, 0.8, 1.6});
  m.right.trace({0, 2}, {0.0, 0.0});
  m.reply();
  const std::optional<Touch> touch = first_overlap(m.joint, m.bodies, 0.0);
  ASSERT_TRUE(touch);
  EXPECT_NEAR(touch->time, 1.25, roundoff(8, 2.0));
  EXPECT_NEAR(touch->speed, 0.8, roundoff(8, 2.0));
}

TEST(FirstOverlap, SidesThatOnlyMeetAreNotApartAndDoNotOverlap) {
  Facing m;
  m.left.trace({0, 1}, {0.0, 1.0});
  m.right.trace({0, 1}, {0.0, 0.0});
  m.reply();
  EXPECT_FALSE(first_overlap(m.joint, m.bodies, 0.0));
}

TEST(FirstOverlap, WhatIsNegligibleIsNone) {
  Facing m;
  m.left.trace({0, 1}, {0.0, 1.0 + 1e-13});  // numerical forerunners
  m.right.trace({0, 1}, {0.0, 0.0});
  m.reply();
  EXPECT_TRUE(first_overlap(m.joint, m.bodies, 0.0));
  EXPECT_FALSE(first_overlap(m.joint, m.bodies, 1e-12));
}

TEST(FirstOverlap, AnOverlapThatGetsSmallerIsARelease) {
  Facing m;
  m.left.trace({0, 1, 2}, {1.01, 1.005, 0.99});
  m.right.trace({0, 2}, {0.0, 0.0});
  m.reply();
  EXPECT_FALSE(first_overlap(m.joint, m.bodies, 0.0));
}

/// What the interface of two scripted bodies shows. Both give way by half a metre per newton.
ContactHistory history(Facing& m) {
  m.left.compliance = m.right.compliance = 0.5;
  m.reply();
  ContactHistory h;
  h.read(m.joint, never_opened, m.bodies);
  return h;
}

TEST(ContactHistory, ReadsForcesAndGapsAtTheSubsteps) {
  Facing m;
  m.left.trace({0, 1, 2}, {0.5, 1.0, 0.75}, {0, -3, 0});  // pushed to the left
  m.right.trace({0, 1, 2}, {0, 0, 0.25});
  const ContactHistory h = history(m);
  ASSERT_EQ(h.size(), 3u);
  EXPECT_EQ(h[0].gap, 0.5);
  EXPECT_EQ(h[1].force, 3.0);
  EXPECT_EQ(h[1].gap, 0.0);
  EXPECT_EQ(h[2].gap, 0.5);
  EXPECT_EQ(h.peak(), 3.0);
}

TEST(ContactHistory, EventsAreWhereGapAndForceOfTheFreeAndTheHeldSidesCrossZero) {
  Facing m;
  m.left.trace({0, 1, 2}, {0.5, 1.0, 0.75}, {0, -3, 0});
  m.right.trace({0, 1, 2}, {0, 0, 0.25});
  const ContactHistory h = history(m);
  // Free, the sides would overlap by 3 N x 1 m/N at 1: a gap of 0.5 m is gone after a seventh.
  EXPECT_NEAR(h.touch(1).time, 0.5 / 3.5, roundoff(8, 1.0));
  EXPECT_NEAR(h.touch(1).speed, 3.5, roundoff(8, 3.5));
  // Held, they would be pulled by 0.5 N at 2: the force of 3 N is gone after six sevenths.
  EXPECT_NEAR(h.release(2), 1.0 + 3.0 / 3.5, roundoff(8, 2.0));
}

TEST(ContactHistory, KnowsTheEnergyOfEventsFromGapsAndForcesAlone) {
  // Goal: [M.25]. Oracle: a spring of 1 N/m that a surface loads, its energy and the work on it.
  Facing m;
  m.left.trace({0, 1, 2, 3}, {0.5, 1.0, 1.0, 0.75}, {0, -3, -2, 0});
  m.right.trace({0, 1, 2, 3}, {0, 0, 0, 0.25});
  const ContactHistory h = history(m);
  EXPECT_EQ(h.energy(1), -0.5 * 3.0 * 0.5);  // closing takes
  EXPECT_EQ(h.energy(2), 0.0);               // closed, contact does no work
  EXPECT_EQ(h.energy(3), 0.5 * 2.0 * 0.5);   // opening gives
}

TEST(ContactHistory, AForceOfKicksActsAtTheBeginOfItsSubstep) {
  Facing m;
  m.left.reply.ports[0].trace.support = ForceSupport::step;
  m.left.trace({0, 1, 2, 3}, {1, 1, 1, 0}, {0, -3, -3, 0});
  m.right.trace({0, 1, 2, 3}, {0, 0, 0, 0});
  const ContactHistory h = history(m);
  EXPECT_TRUE(h.kicks());
  EXPECT_EQ(h.release(3), 1.0 + 3.0 / 4.0);  // 3 N act at 1, held sides would be pulled by 1 N at 2
}

TEST(ContactHistory, JudgesTheMeansOverTheCoarserSide) {
  Facing m(0.5, 2.0);  // a hole in the force of the finer, kinematic side is none of the coarser
  m.left.trace({0, .5, 1, 1.5, 2, 2.5, 3, 3.5, 4}, {1, 1, 1, 1, 1, 1, 1, 1, 1},
               {-4, -4, 0, -4, -4, -4, -4, -4, -4});
  m.right.trace({0, 2, 4}, {0, 0, 0});
  ContactHistory h = history(m);
  ASSERT_EQ(h.size(), 3u);
  EXPECT_GT(h[1].force, 0.0);
  EXPECT_GT(h[2].force, 0.0);
  m.left.trace({0, .5, 1, 1.5, 2, 2.5, 3, 3.5, 4}, {1, 1, 1, 1, 1, .75, .5, .25, 0},
               {-4, -4, -4, -4, -1, 0, 0, 0, 0});
  h = history(m);
  EXPECT_EQ(h[2].force, 0.0);
  // located on the finer side: 1 N at 2, a pull of 0.25 N at 2.5
  EXPECT_NEAR(h.release(2), 2.0 + 0.5 * 0.8, roundoff(8, 4.0));
}

TEST(PayingImpulse, GivesExactlyWhatIsOwed) {
  // Goal: [M.26]. Oracle: the energy of two masses before and after the impulse.
  for (double debt : {0.3, -0.3, 1e-9}) {
    for (double approach : {2.0, -2.0}) {
      Facing m;
      m.left.reply.ports[0].recoil = Recoil{approach, 1.0 / 2.0};
      m.right.reply.ports[0].recoil = Recoil{0.0, 1.0 / 3.0};
      m.reply();
      const double j = paying_impulse(m.joint, debt, m.bodies);
      const auto energy = [](double mass, double v) { return 0.5 * mass * v * v; };
      const double left = approach - j / 2.0, right = -j / 3.0;
      EXPECT_NEAR(energy(2.0, left) + energy(3.0, right) - energy(2.0, approach), debt,
                  roundoff(16, 4.0));
      EXPECT_LT(std::abs(j), 2.0);  // the smaller root
    }
  }
}

TEST(PayingImpulse, TakesBackNoMoreThanThereIsAndWaitsWhereItWouldStirUpMore) {
  Facing m;
  m.left.reply.ports[0].recoil = Recoil{2.0, 0.5};
  m.right.reply.ports[0].recoil = Recoil{};  // a wall
  m.reply();
  EXPECT_EQ(paying_impulse(m.joint, -100.0, m.bodies), 4.0);  // stops it: 4 J of the 100
  EXPECT_EQ(paying_impulse(m.joint, 100.0, m.bodies), 0.0);
}

TEST(ReleaseImpulse, GivesBackAllThatContactTook) {
  Facing m;
  m.left.reply.ports[0].recoil = Recoil{0.5, 0.5};
  m.right.reply.ports[0].recoil = Recoil{};
  m.reply();
  const double j = release_impulse(m.joint, 2.0, m.bodies);
  EXPECT_NEAR(0.5 * 2.0 * std::pow(0.5 - j / 2.0, 2) - 0.5 * 2.0 * 0.25, 2.0, roundoff(16, 2.0));
  EXPECT_GT(j, 0.0);  // apart
}

TEST(Horizon, IsTheGapOverTheBoundOfTheClosingSpeedAndAMargin) {
  Facing m;
  m.left.trace({0.0}, {0.2});
  m.right.trace({0.0}, {-0.3});
  m.left.reply.ports[0].speed_bound = 2.0;
  m.right.reply.ports[0].speed_bound = 3.0;
  m.reply();
  const double horizon = free_flight_horizon({&m.joint, 1}, m.bodies);
  EXPECT_LE(horizon, 0.5 / 5.0);  // never later than the touch
  EXPECT_GE(horizon, 0.9 * 0.5 / 5.0);
}

TEST(Horizon, CountsTheAccelerationOfBodyForces) {
  Facing m;
  m.left.trace({0.0}, {0.0});
  m.right.trace({0.0}, {0.0});
  m.left.reply.ports[0].acceleration_bound = 2.0;
  m.reply();
  const double horizon = free_flight_horizon({&m.joint, 1}, m.bodies);
  EXPECT_LE(horizon, 1.0);  // 1 m at 2 m/s^2 from rest
  EXPECT_GE(horizon, 0.9);
  m.left.reply.ports[0].speed_bound = -1.0;  // moving apart first: back after 1 s, there at 1.618
  m.reply();
  const double later = free_flight_horizon({&m.joint, 1}, m.bodies);
  EXPECT_GT(later, 1.0);
  EXPECT_LE(later, 0.5 * (1.0 + std::sqrt(5.0)));
}

TEST(Horizon, IsEndlessForBodiesThatPartAndNothingForContact) {
  Facing m;
  m.left.trace({0.0}, {0.0});
  m.right.trace({0.0}, {0.0});
  m.left.reply.ports[0].speed_bound = -1.0;
  m.reply();
  EXPECT_TRUE(std::isinf(free_flight_horizon({&m.joint, 1}, m.bodies)));
  m.joint.exchange = std::make_unique<Unilateral>();
  m.joint.engage(1.0);
  EXPECT_EQ(free_flight_horizon({&m.joint, 1}, m.bodies), 0.0);
  m.joint.disengage();
  m.left.trace({0.0}, {1.0});
  m.reply();
  EXPECT_EQ(free_flight_horizon({&m.joint, 1}, m.bodies), 0.0);
}

TEST(Horizon, SweptBoxesThatMeetInAnyPartAreSeen) {
  Facing m;
  m.left.reply.ports[0].lower = {-1.0, -1.0};
  m.left.reply.ports[0].upper = {-0.6, -0.1};
  m.right.reply.ports[0].lower = {-0.5, -0.05};
  m.right.reply.ports[0].upper = {0.0, 0.0};
  m.reply();
  EXPECT_TRUE(stayed_apart({&m.joint, 1}, m.bodies, 1.0));
  m.left.reply.ports[0].upper = {-0.5, -0.1};  // in the first part
  m.reply();
  EXPECT_FALSE(stayed_apart({&m.joint, 1}, m.bodies, 1.0));
}

}  // namespace
}  // namespace abut::coupling_criteria_tests
