// Goal: the exact bar impact is exact. Oracles: conservation of energy and momentum, the published
// table values of wave theory (equal bars, unequal impedance, unequal length), and derivative =
// velocity.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "coordinator/closed_form.hpp"

namespace abut {
namespace {

// A closed form is a few dozen operations on numbers of the scale given.
constexpr double roundoff = 1e-13;

BarData bar(double normal, double velocity, double length = 1.0, double impedance = 1.0) {
  BarData data;  // wave speed 1
  data.name = normal > 0.0 ? "left" : "right";
  data.youngs_modulus = impedance;
  data.density = impedance;
  data.area = 1.0;
  data.length = length;
  data.velocity = velocity;
  data.normal = normal;
  return data;
}

BarData wall(double normal) {
  BarData data;
  data.name = "wall";
  data.wall = true;
  data.normal = normal;
  return data;
}

BarImpact two_bars() {
  BarData left = bar(1.0, 100.0, 0.25);
  left.youngs_modulus = 1e9;
  left.density = 1000.0;
  left.area = 1e-6;
  BarData right = left;
  right.normal = -1.0;
  right.velocity = -100.0;
  return BarImpact({left, right}, 0.04, -2e-4);
}

TEST(BarImpact, CanonicalBarsTouchAfterTheGapAndPartAfterOneTransit) {
  const BarImpact impact = two_bars();
  EXPECT_NEAR(impact.begin(), 0.0, roundoff * 2e-4);
  EXPECT_NEAR(impact.duration(), 5e-4, roundoff * 5e-4);
  EXPECT_NEAR(impact.force(), 100.0, roundoff * 100.0);
  EXPECT_NEAR(impact.velocity(0, 2e-4), 0.0, roundoff * 100.0);
  EXPECT_NEAR(impact.velocity(0, 6e-4), -100.0, roundoff * 100.0);
  EXPECT_NEAR(impact.displacement(0, 2e-4), 0.02, roundoff * 0.02);
  EXPECT_NEAR(impact.displacement(1, 6e-4), -0.01, roundoff * 0.02);
  EXPECT_NEAR(impact.mean_velocity(0, 1.25e-4), 50.0, roundoff * 100.0);
  EXPECT_NEAR(impact.mean_velocity(1, 8e-4), 100.0, roundoff * 100.0);
}

TEST(BarImpact, CanonicalEnergyIsAllStoredAtMidContact) {
  const BarImpact impact = two_bars();
  for (const int side : {0, 1}) {
    EXPECT_NEAR(impact.kinetic(side, -1e-4), 1.25, roundoff);
    EXPECT_NEAR(impact.kinetic(side, 2.5e-4), 0.0, roundoff);
    EXPECT_NEAR(impact.stored(side, 2.5e-4), 1.25, roundoff);
    EXPECT_NEAR(impact.stored(side, 1.25e-4), 0.625, roundoff);
    EXPECT_NEAR(impact.kinetic(side, 7e-4), 1.25, roundoff);
  }
}

TEST(BarImpact, GapClosesLinearlyStaysShutAndReopens) {
  const BarImpact impact = two_bars();
  EXPECT_NEAR(impact.gap(-2e-4), 0.04, roundoff);
  EXPECT_NEAR(impact.gap(-1e-4), 0.02, roundoff);
  EXPECT_EQ(impact.gap(3e-4), 0.0);
  EXPECT_NEAR(impact.gap(6e-4), 0.02, roundoff);
}

TEST(BarImpact, PortForceActsAgainstTheNormalAndOnlyInContact) {
  const BarImpact impact = two_bars();
  EXPECT_NEAR(impact.port_force(0, 1e-4), -100.0, roundoff * 100.0);
  EXPECT_NEAR(impact.port_force(1, 1e-4), 100.0, roundoff * 100.0);
  EXPECT_EQ(impact.port_force(0, -1e-4), 0.0);
  EXPECT_EQ(impact.port_force(0, 6e-4), 0.0);
}

TEST(BarImpact, LongerPartnerOfEqualImpedanceKeepsVibrating) {  // A3, length ratio 2
  const BarImpact impact({bar(1.0, 1.0), bar(-1.0, 0.0, 2.0)}, 0.0, 0.0);
  EXPECT_NEAR(impact.force(), 0.5, roundoff);
  EXPECT_NEAR(impact.end(), 2.0, roundoff);
  EXPECT_NEAR(impact.mean_velocity(0, 9.0), 0.0, roundoff);
  EXPECT_NEAR(impact.mean_velocity(1, 9.0), 0.5, roundoff);
  // The faces touch without force until the echo is back at 2 L2 / c = 4, then part.
  EXPECT_NEAR(impact.gap(3.0), 0.0, roundoff);
  EXPECT_NEAR(impact.velocity(1, 3.0), 0.0, roundoff);
  EXPECT_NEAR(impact.velocity(1, 5.0), 1.0, roundoff);
  EXPECT_NEAR(impact.gap(5.0), 1.0, roundoff);
  // Half of the energy is left as vibration: total minus that of the mean motion.
  const double mean = 0.5 * 2.0 * 0.5 * 0.5;
  EXPECT_NEAR(impact.total(1, 9.3) - mean, 0.25, roundoff);
}

TEST(BarImpact, ImpedanceRatioGivesTheElasticCollisionOfMasses) {  // A4
  for (const double ratio : {1e-6, 1e-3, 0.25, 0.5, 2.0, 4.0, 1e3, 1e6}) {
    const BarImpact impact({bar(1.0, 1.0), bar(-1.0, 0.0, 1.0, ratio)}, 0.0, 0.0);
    EXPECT_NEAR(impact.force(), ratio / (1.0 + ratio), roundoff);
    EXPECT_NEAR(impact.mean_velocity(0, 3.0), (1.0 - ratio) / (1.0 + ratio), roundoff);
    EXPECT_NEAR(impact.mean_velocity(1, 3.0), 2.0 / (1.0 + ratio), 2.0 * roundoff);
    // Nothing vibrates: all energy is that of the mean motion.
    EXPECT_NEAR(impact.stored(0, 3.0), 0.0, roundoff);
    EXPECT_NEAR(impact.stored(1, 3.0) / ratio, 0.0, 2.0 * roundoff);
  }
}

TEST(BarImpact, BarLeavesAWallWithItsSpeedReversed) {
  const BarImpact impact({wall(1.0), bar(-1.0, -3.0, 2.0, 4.0)}, 0.3, 1.0);
  EXPECT_NEAR(impact.begin(), 1.1, roundoff);
  EXPECT_NEAR(impact.force(), 12.0, roundoff * 12.0);
  EXPECT_NEAR(impact.duration(), 4.0, roundoff * 4.0);
  EXPECT_NEAR(impact.velocity(1, 3.0), 0.0, roundoff * 3.0);
  EXPECT_NEAR(impact.velocity(1, 5.2), 3.0, roundoff * 3.0);
  EXPECT_NEAR(impact.displacement(1, 3.0), -0.3, roundoff);
  EXPECT_EQ(impact.displacement(0, 3.0), 0.0);
  EXPECT_NEAR(impact.gap(6.1), 3.0, roundoff * 10.0);
}

/// Impacts of every kind the solution covers.
std::vector<BarImpact> impacts() {
  return {two_bars(),
          BarImpact({bar(1.0, 1.0), bar(-1.0, 0.0, 2.0)}, 0.0, 0.0),
          BarImpact({bar(1.0, 1.0, 0.7, 0.4), bar(-1.0, -0.3, 2.9, 1.7)}, 0.1, 0.0),
          BarImpact({bar(1.0, 2.0, 3.3, 2.5), bar(-1.0, 0.5, 1.0, 0.9)}, 0.2, -1.0),
          BarImpact({bar(1.0, 1.0, 1.0, 3.0), bar(-1.0, 0.0, 1.0, 1.0)}, 0.0, 0.0),
          BarImpact({bar(1.0, 1.5, 0.8, 2.0), wall(-1.0)}, 0.1, 0.0)};
}

TEST(BarImpact, TotalEnergyIsConservedAtAllTimes) {
  for (const BarImpact& impact : impacts()) {
    const double initial =
        impact.total(0, impact.run_begin()) + impact.total(1, impact.run_begin());
    for (int i = 0; i < 997; ++i) {
      const double time = impact.begin() + (i - 50) * 0.0137 * impact.duration();
      const double now = impact.total(0, time) + impact.total(1, time);
      EXPECT_NEAR(now, initial, 10.0 * roundoff * initial) << "at " << time;
    }
  }
}

TEST(BarImpact, TotalMomentumIsConservedBetweenBars) {
  for (const BarImpact& impact : impacts()) {
    if (impact.is_wall(0) || impact.is_wall(1)) continue;
    const double initial =
        impact.momentum(0, impact.run_begin()) + impact.momentum(1, impact.run_begin());
    const double scale = impact.force() * impact.duration();
    for (int i = 0; i < 200; ++i) {
      const double time = impact.begin() + (i - 20) * 0.0137 * impact.duration();
      EXPECT_NEAR(impact.momentum(0, time) + impact.momentum(1, time), initial,
                  10.0 * roundoff * scale);
    }
  }
}

TEST(BarImpact, ContactPointsMoveTogetherInContactAndNeverOverlap) {
  for (const BarImpact& impact : impacts()) {
    for (int i = 0; i < 400; ++i) {
      const double time = impact.begin() + (i + 0.5) * 0.0137 * impact.duration();
      if (impact.closed(time)) {
        EXPECT_NEAR(impact.velocity(0, time), impact.velocity(1, time),
                    10.0 * roundoff * impact.closing_speed());
      } else {
        const double gap = impact.gap(impact.run_begin()) - impact.displacement(0, time) +
                           impact.displacement(1, time);
        EXPECT_GE(gap, -10.0 * roundoff * impact.closing_speed() * time);
        EXPECT_NEAR(impact.gap(time), gap, 10.0 * roundoff * impact.closing_speed() * time);
      }
    }
  }
}

TEST(BarImpact, DisplacementIsTheIntegralOfVelocity) {
  for (const BarImpact& impact : impacts()) {
    for (const int side : {0, 1}) {
      const double half = 1e-4 * impact.duration();
      for (int i = 0; i < 300; ++i) {
        const double time = impact.begin() + (i - 20.3) * 0.0137 * impact.duration();
        const double before = impact.velocity(side, time - half);
        if (std::abs(before - impact.velocity(side, time + half)) > 0.0)
          continue;  // a jump between
        const double slope =
            (impact.displacement(side, time + half) - impact.displacement(side, time - half)) /
            (2.0 * half);
        // A difference of two displacements of about v * duration, divided by 2e-4 of that time.
        EXPECT_NEAR(slope, before, 1e-9 * impact.closing_speed()) << "at " << time;
      }
    }
  }
}

TEST(BarImpact, WorkOfTheContactForceIsTheBodysGainInEnergy) {
  for (const BarImpact& impact : impacts()) {
    for (const int side : {0, 1}) {
      const double from = impact.begin();
      for (const double part : {0.1, 0.5, 0.77, 1.0}) {
        const double to = impact.begin() + part * impact.duration();
        const double inside = 0.5 * (from + to);
        const double travel = impact.displacement(side, to) - impact.displacement(side, from);
        const double gain = impact.total(side, to) - impact.total(side, from);
        const double scale = impact.total(0, from) + impact.total(1, from);
        EXPECT_NEAR(gain, impact.port_force(side, inside) * travel, 100.0 * roundoff * scale);
      }
    }
  }
}

std::string reason(const std::array<BarData, 2>& sides, double gap = 0.0) {
  try {
    const BarImpact impact(sides, gap, 0.0);
  } catch (const InputError& error) {
    return error.what_is_wrong;
  }
  return "";
}

TEST(BarImpact, RefusesStaircaseForcesAndSaysWhichBarEchoesFirst) {  // A5
  EXPECT_NE(reason({bar(1.0, 1.0), bar(-1.0, 0.0, 2.0, 0.5)}).find("first echo returns in left"),
            std::string::npos);
  EXPECT_NE(reason({bar(1.0, 1.0), bar(-1.0, 0.0, 0.5, 4.0)}).find("first echo returns in right"),
            std::string::npos);
  EXPECT_EQ(reason({bar(1.0, 1.0), bar(-1.0, 0.0, 0.5, 0.5)}), "");
}

TEST(BarImpact, RefusesWhatItCannotDescribe) {
  BarData fixed = bar(1.0, 1.0);
  fixed.free = false;
  BarData pulled = bar(1.0, 1.0);
  pulled.body_force = 9.81;
  EXPECT_NE(reason({fixed, wall(-1.0)}).find("left has a fixed end"), std::string::npos);
  EXPECT_NE(reason({pulled, wall(-1.0)}).find("a body force acts on left"), std::string::npos);
  EXPECT_NE(reason({bar(1.0, -1.0), wall(-1.0)}).find("do not approach"), std::string::npos);
  EXPECT_NE(reason({bar(1.0, 1.0), wall(-1.0)}, -0.1).find("overlap"), std::string::npos);
  EXPECT_NE(reason({bar(1.0, 1.0), wall(1.0)}).find("face each other"), std::string::npos);
  EXPECT_NE(reason({wall(1.0), wall(-1.0)}).find("both sides are walls"), std::string::npos);
}

}  // namespace
}  // namespace abut
