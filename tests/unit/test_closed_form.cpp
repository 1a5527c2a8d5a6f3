// Goal: the closed form bar_impact describes one contact of constant force, and nothing else.
// Oracle: wave theory by hand. The solution itself is tested in test_bar_row.cpp.
#include <array>
#include <string>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "coordinator/exact/closed_form.hpp"

namespace abut::test_closed_form {
namespace {

// A closed form is a few dozen operations on numbers of the scale given.
constexpr double roundoff = 1e-13;

constexpr std::array<BarEnd, 2> facing = {BarEnd{0, 1}, BarEnd{1, 0}};
constexpr BarEnd left_tip = facing[0], right_tip = facing[1];

RowBar bar(const std::string& name, double position, double velocity, double length = 1.0,
           double impedance = 1.0) {
  RowBar data;  // wave speed 1
  data.name = name;
  data.youngs_modulus = data.density = impedance;
  data.area = 1.0;
  data.length = length;
  data.position = position;
  data.velocity = velocity;
  return data;
}

RowBar wall(double position) {
  RowBar data;
  data.name = "wall";
  data.wall = true;
  data.position = position;
  return data;
}

BarRow two_bars(double end = 8e-4) {
  RowBar left = bar("left", -0.27, 100.0, 0.25), right = bar("right", 0.02, -100.0, 0.25);
  for (RowBar* each : {&left, &right}) {
    each->youngs_modulus = 1e9;
    each->density = 1000.0;
    each->area = 1e-6;
  }
  return bar_impact({left, right}, facing, -2e-4, end);
}

TEST(BarImpact, CanonicalBarsTouchAfterTheGapAndPartAfterOneTransit) {
  const BarRow impact = two_bars();
  const RowContact& contact = impact.contacts()[0];
  EXPECT_NEAR(contact.begin(), 0.0, roundoff * 2e-4);
  EXPECT_NEAR(contact.duration(), 5e-4, roundoff * 5e-4);
  EXPECT_NEAR(contact.force_peak(), 100.0, roundoff * 100.0);
  EXPECT_NEAR(impact.velocity(left_tip, 2e-4), 0.0, roundoff * 100.0);
  EXPECT_NEAR(impact.velocity(left_tip, 6e-4), -100.0, roundoff * 100.0);
  EXPECT_NEAR(impact.displacement(left_tip, 2e-4), 0.02, roundoff * 0.02);
  EXPECT_NEAR(impact.displacement(right_tip, 6e-4), -0.01, roundoff * 0.02);
  EXPECT_NEAR(impact.mean_velocity(0, 1.25e-4), 50.0, roundoff * 100.0);
  EXPECT_NEAR(impact.mean_velocity(1, 8e-4), 100.0, roundoff * 100.0);
}

TEST(BarImpact, CanonicalEnergyIsAllStoredAtMidContact) {
  const BarRow impact = two_bars();
  for (const int side : {0, 1}) {
    EXPECT_NEAR(impact.kinetic(side, -1e-4), 1.25, roundoff);
    EXPECT_NEAR(impact.kinetic(side, 2.5e-4), 0.0, roundoff);
    EXPECT_NEAR(impact.stored(side, 2.5e-4), 1.25, roundoff);
    EXPECT_NEAR(impact.stored(side, 1.25e-4), 0.625, roundoff);
    EXPECT_NEAR(impact.kinetic(side, 7e-4), 1.25, roundoff);
  }
}

TEST(BarImpact, GapClosesLinearlyStaysShutAndReopens) {
  const BarRow impact = two_bars();
  EXPECT_NEAR(impact.gap(0, -2e-4), 0.04, roundoff);
  EXPECT_NEAR(impact.gap(0, -1e-4), 0.02, roundoff);
  EXPECT_EQ(impact.gap(0, 3e-4), 0.0);
  EXPECT_NEAR(impact.gap(0, 6e-4), 0.02, roundoff);
}

TEST(BarImpact, ForceActsAgainstTheNormalAndOnlyInContact) {
  const BarRow impact = two_bars();
  EXPECT_NEAR(impact.force(left_tip, 1e-4), -100.0, roundoff * 100.0);
  EXPECT_NEAR(impact.force(right_tip, 1e-4), 100.0, roundoff * 100.0);
  EXPECT_EQ(impact.force(left_tip, -1e-4), 0.0);
  EXPECT_EQ(impact.force(left_tip, 6e-4), 0.0);
}

TEST(BarImpact, GoesOnToTheReleaseWhereTheRunEndsBefore) {
  const BarRow impact = two_bars(1e-4);
  EXPECT_FALSE(impact.contacts()[0].pressed_at_end);
  EXPECT_NEAR(impact.contacts()[0].end(), 5e-4, roundoff);
}

TEST(BarImpact, BarLeavesAWallWithItsSpeedReversed) {
  const BarRow impact = bar_impact({wall(0.0), bar("bar", 0.3, -3.0, 2.0, 4.0)}, facing, 1.0, 9.0);
  const RowContact& contact = impact.contacts()[0];
  EXPECT_NEAR(contact.begin(), 1.1, roundoff);
  EXPECT_NEAR(contact.force_peak(), 12.0, roundoff * 12.0);
  EXPECT_NEAR(contact.duration(), 4.0, roundoff * 4.0);
  EXPECT_NEAR(impact.velocity(right_tip, 3.0), 0.0, roundoff * 3.0);
  EXPECT_NEAR(impact.velocity(right_tip, 5.2), 3.0, roundoff * 3.0);
  EXPECT_NEAR(impact.displacement(right_tip, 3.0), -0.3, roundoff);
  EXPECT_EQ(impact.displacement(left_tip, 3.0), 0.0);
  EXPECT_NEAR(impact.gap(0, 6.1), 3.0, roundoff * 10.0);
}

std::string reason(const RowBar& first, const RowBar& second) {
  try {
    bar_impact({first, second}, facing, 0.0, 1.0);
  } catch (const InputError& error) {
    return error.what_is_wrong;
  }
  return "";
}

TEST(BarImpact, RefusesStaircaseForcesAndSaysWhen) {  // A5
  const RowBar blow = bar("left", 0.0, 1.0);
  EXPECT_NE(reason(blow, bar("right", 1.0, 0.0, 2.0, 0.5)).find("is back, at 2 s"),
            std::string::npos);
  EXPECT_NE(reason(blow, bar("right", 1.0, 0.0, 0.5, 4.0)).find("from 0.8 N to 0.48 N"),
            std::string::npos);
  EXPECT_EQ(reason(blow, bar("right", 1.0, 0.0, 0.5, 0.5)), "");
}

TEST(BarImpact, RefusesWhatItCannotDescribe) {
  RowBar fixed = bar("left", 0.0, 1.0);
  fixed.fixed[0] = true;
  RowBar pulled = bar("left", 0.0, 1.0);
  pulled.body_force = 9.81;
  const RowBar bar_at_rest = bar("right", 1.0, 0.0);
  EXPECT_NE(reason(fixed, wall(1.0)).find("left has a fixed end"), std::string::npos);
  EXPECT_NE(reason(pulled, wall(1.0)).find("a body force acts on left"), std::string::npos);
  EXPECT_NE(reason(bar("left", 0.0, -1.0), wall(1.0)).find("do not approach"), std::string::npos);
  EXPECT_NE(reason(bar("left", 0.1, 1.0), bar_at_rest).find("overlap"), std::string::npos);
}

TEST(ClosedForm, CountsTimeInContactOnceWhereInterfacesPressTogether) {
  const std::vector<std::array<BarEnd, 2>> interfaces = {facing, {BarEnd{1, 1}, BarEnd{2, 0}}};
  const ClosedForm form{
      "bars",
      BarRow({bar("a", -1.0, 1.0), bar("b", 0.0, 0.0), bar("c", 1.0, 0.0)}, interfaces, 0.0, 5.0),
      {"first", "second"},
      {"a", "b", "c"}};
  EXPECT_NEAR(form.contact_time(), 3.0, 10.0 * roundoff);  // 0 to 2 and 1 to 3
  EXPECT_EQ(form.interface_index("second"), 1);
  EXPECT_EQ(form.interface_index("third"), -1);
  EXPECT_EQ(form.bar_index("c"), 2);
}

}  // namespace
}  // namespace abut::test_closed_form
