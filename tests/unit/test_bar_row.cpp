// Goal: the exact solution for bars in a row is exact. Oracles: tables A3 to A7 and A10 of the
// benchmark catalogue (wave theory by hand), conservation of energy and momentum, work of the
// contact forces, bodies that never overlap.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "coordinator/exact/bar_row.hpp"

namespace abut::test_bar_row {
namespace {

// A value of the solution is some dozens of operations on numbers of the scale given.
constexpr double roundoff = 1e-12;

RowBar bar(double position, double velocity, double length = 1.0, double impedance = 1.0) {
  RowBar data;  // wave speed 1
  data.name = "bar";
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

/// Each meets its right neighbour.
BarRow row(const std::vector<RowBar>& bars, double end) {
  std::vector<std::array<BarEnd, 2>> interfaces;
  for (int b = 0; b + 1 < static_cast<int>(bars.size()); ++b)
    interfaces.push_back({BarEnd{b, 1}, BarEnd{b + 1, 0}});
  return BarRow(bars, interfaces, 0.0, end);
}

/// A bar of length, impedance and velocity 1 that touches one at rest.
BarRow pair(double length, double impedance, double end) {
  return row({bar(-1.0, 1.0), bar(0.0, 0.0, length, impedance)}, end);
}

struct Step {
  double begin, end, force;
};

void expect_steps(const RowContact& contact, const std::vector<Step>& steps) {
  ASSERT_EQ(contact.stretches.size(), steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_NEAR(contact.stretches[i].begin, steps[i].begin, 10.0 * roundoff) << i;
    EXPECT_NEAR(contact.stretches[i].end, steps[i].end, 10.0 * roundoff) << i;
    EXPECT_NEAR(contact.stretches[i].force, steps[i].force, roundoff) << i;
  }
}

double vibration(const BarRow& r, int bar, double time) {  // [J]
  const double mean = r.mean_velocity(bar, time);
  return r.total(bar, time) - 0.5 * r.mass(bar) * mean * mean;
}

TEST(BarRow, UnequalLengthsTouchWithoutForceUntilTheEchoIsBack) {  // A3
  for (const double length : {2.0, 3.0, 0.5}) {
    const BarRow r = pair(length, 1.0, 9.3);
    expect_steps(r.contacts()[0], {{0.0, std::min(2.0, 2.0 * length), 0.5}});
    EXPECT_NEAR(r.mean_velocity(0, 9.3), length < 1.0 ? 0.5 : 0.0, roundoff);
    EXPECT_NEAR(r.mean_velocity(1, 9.3), length < 1.0 ? 1.0 : 1.0 / length, roundoff);
    const double left = length < 1.0 ? 0.25 : 1.0 - 1.0 / length;
    EXPECT_NEAR((vibration(r, 0, 9.3) + vibration(r, 1, 9.3)) / 0.5, left, roundoff);
  }
  const BarRow r = pair(2.0, 1.0, 6.0);
  EXPECT_EQ(r.gap(0, 3.0), 0.0);
  EXPECT_EQ(r.velocity({1, 0}, 3.0), 0.0);
  EXPECT_NEAR(r.velocity({1, 0}, 5.0), 1.0, roundoff);
  EXPECT_NEAR(r.gap(0, 5.0), 1.0, roundoff);
}

TEST(BarRow, EqualTransitsGiveTheElasticCollisionOfMasses) {  // A4
  for (const double z : {1e-6, 1e-3, 0.25, 0.5, 1.0, 2.0, 4.0, 1e3, 1e6}) {
    const BarRow r = pair(1.0, z, 3.5);
    expect_steps(r.contacts()[0], {{0.0, 2.0, z / (1.0 + z)}});
    EXPECT_NEAR(r.mean_velocity(0, 3.5), (1.0 - z) / (1.0 + z), roundoff);
    EXPECT_NEAR(r.mean_velocity(1, 3.5), 2.0 / (1.0 + z), 2.0 * roundoff);
    EXPECT_NEAR(vibration(r, 0, 3.5) + vibration(r, 1, 3.5), 0.0, roundoff);
  }
}

TEST(BarRow, UnequalImpedanceAndLengthGiveAStaircase) {  // A5
  struct Case {
    double length, z;
    std::vector<Step> steps;
    double first, second, vibration;
  };
  const std::vector<Case> cases = {
      {2.0, 0.5, {{0, 2, 1.0 / 3}, {2, 4, 1.0 / 9}}, 1.0 / 9, 8.0 / 9, 16.0 / 81},
      {2.0, 0.25, {{0, 2, 0.2}, {2, 4, 0.12}}, 0.36, 1.28, 0.0512},
      {3.0,
       0.5,
       {{0, 2, 1.0 / 3}, {2, 4, 1.0 / 9}, {4, 6, 1.0 / 27}},
       1.0 / 27,
       52.0 / 81,
       0.380430},
      {0.5, 2.0, {{0, 1, 2.0 / 3}, {1, 2, 2.0 / 9}}, 1.0 / 9, 8.0 / 9, 16.0 / 81},
      {0.5, 4.0, {{0, 1, 0.8}, {1, 2, 0.48}}, -0.28, 0.64, 0.1024}};
  for (const Case& c : cases) {
    const BarRow r = pair(c.length, c.z, 8.3);
    EXPECT_EQ(r.contacts()[0].count(), 1);
    expect_steps(r.contacts()[0], c.steps);
    EXPECT_NEAR(r.mean_velocity(0, 8.3), c.first, roundoff);
    EXPECT_NEAR(r.mean_velocity(1, 8.3), c.second, roundoff);
    // 6 digits in the table
    EXPECT_NEAR((vibration(r, 0, 8.3) + vibration(r, 1, 8.3)) / 0.5, c.vibration, 1e-6);
  }
}

TEST(BarRow, ThreeBarsPassTheBlowOn) {  // A6
  for (const double gap : {0.0, 0.1}) {
    const BarRow r = row({bar(-1.0, 1.0), bar(0.0, 0.0), bar(1.0 + gap, 0.0)}, 5.0);
    expect_steps(r.contacts()[0], {{0.0, 2.0, 0.5}});
    expect_steps(r.contacts()[1], {{1.0 + gap, 3.0 + gap, 0.5}});
    for (const int b : {0, 1, 2}) {
      EXPECT_NEAR(r.mean_velocity(b, 5.0), b == 2 ? 1.0 : 0.0, roundoff);
      EXPECT_NEAR(vibration(r, b, 5.0), 0.0, roundoff);
    }
    EXPECT_NEAR(r.gap(0, 5.0), gap, roundoff);
  }
}

TEST(BarRow, CradleOfFiveSendsOffTheLast) {  // A6
  const BarRow r =
      row({bar(0.0, 1.0), bar(1.0, 0.0), bar(2.0, 0.0), bar(3.0, 0.0), bar(4.0, 0.0)}, 7.0);
  for (int k = 0; k < 4; ++k) expect_steps(r.contacts()[k], {{1.0 * k, k + 2.0, 0.5}});
  EXPECT_NEAR(r.mean_velocity(4, 5.0), 1.0, roundoff);
  for (int b = 0; b < 4; ++b) EXPECT_NEAR(r.total(b, 7.0), 0.0, roundoff);
}

TEST(BarRow, HitFromBothSidesStaysAndTheOthersTurnBack) {  // A6
  const BarRow r = row({bar(-1.0, 1.0), bar(0.0, 0.0), bar(1.0, -1.0)}, 5.0);
  for (const RowContact& contact : r.contacts()) {
    expect_steps(contact, {{0, 1, 0.5}, {1, 2, 1.0}, {2, 3, 0.5}});
    EXPECT_EQ(contact.count(), 1);
    EXPECT_NEAR(contact.impulse(), 2.0, roundoff);
    EXPECT_NEAR(contact.force_peak(), 1.0, roundoff);
  }
  for (const int b : {0, 1, 2}) EXPECT_NEAR(r.mean_velocity(b, 5.0), b - 1.0, roundoff);
}

TEST(BarRow, ChainOfFallingImpedancesSpeedsUp) {  // A6
  const BarRow r = row({bar(-1.0, 1.0), bar(0.0, 0.0, 1.0, 0.5), bar(1.0, 0.0, 1.0, 0.25)}, 5.0);
  expect_steps(r.contacts()[0], {{0.0, 2.0, 1.0 / 3}});
  expect_steps(r.contacts()[1], {{1.0, 3.0, 2.0 / 9}});
  EXPECT_NEAR(r.mean_velocity(0, 5.0), 1.0 / 3, roundoff);
  EXPECT_NEAR(r.mean_velocity(1, 5.0), 4.0 / 9, roundoff);
  EXPECT_NEAR(r.mean_velocity(2, 5.0), 16.0 / 9, roundoff);
}

TEST(BarRow, EchoOfAClampedEndMeetsTheBarAgain) {  // A7
  const auto on_clamped = [](double length) {
    std::vector<RowBar> bars = {bar(-1.0, 1.0), bar(0.0, 0.0, length)};
    bars[1].fixed[1] = true;
    return row(bars, 9.5);
  };
  const BarRow two = on_clamped(2.0), three = on_clamped(3.0), one = on_clamped(1.0),
               half = on_clamped(0.5);
  expect_steps(two.contacts()[0], {{0, 2, 0.5}, {4, 6, 0.5}});
  EXPECT_EQ(two.contacts()[0].count(), 2);
  expect_steps(three.contacts()[0], {{0, 2, 0.5}, {6, 8, 0.5}});
  expect_steps(one.contacts()[0], {{0, 2, 0.5}, {2, 4, 0.5}});  // the contact point turns back
  expect_steps(half.contacts()[0], {{0, 1, 0.5}, {1, 2, 1.0}, {2, 3, 0.5}});
  EXPECT_EQ(half.contacts()[0].count(), 1);
  for (const BarRow* r : {&two, &three, &one, &half}) {
    EXPECT_NEAR(r->mean_velocity(0, 9.5), -1.0, roundoff);
    EXPECT_EQ(r->velocity({1, 1}, 9.5), 0.0);
  }
}

TEST(BarRow, BetweenTwoWallsABarComesAndGoesForAThousandPeriods) {  // A10
  const double period = 14.0, run = 1000.0 * period;
  const BarRow r = row({wall(0.0), bar(0.25, 0.1), wall(1.5)}, run);
  // Rounding of 2000 impact times at the end of the run, relative to it.
  const double slip = 1e-11 * run;
  EXPECT_EQ(r.contacts()[0].count(), 1000);
  EXPECT_EQ(r.contacts()[1].count(), 1000);
  for (int k = 0; k < 1000; ++k) {
    const RowContact::Stretch& s = r.contacts()[1].stretches[k];
    EXPECT_NEAR(s.begin, 2.5 + period * k, slip);
    EXPECT_NEAR(s.end, 4.5 + period * k, slip);
    EXPECT_NEAR(s.force, 0.1, roundoff);
  }
  for (int i = 0; i <= 997; ++i)
    EXPECT_NEAR(r.total(1, run * i / 997.0), 0.005, 0.005 * 1e-9);  // slip over a transit
}

/// Rows without any symmetry, with gaps, walls and clamped ends.
std::vector<BarRow> rows() {
  std::vector<RowBar> clamped = {bar(-1.1, 1.0, 0.7, 0.4), bar(0.0, -0.3, 2.9, 1.7),
                                 bar(3.0, -0.1, 0.37, 5.0)};
  clamped[2].fixed[1] = true;
  std::vector<BarRow> all;
  all.push_back(row(clamped, 30.0));
  all.push_back(row(
      {wall(0.0), bar(0.1, 0.3), bar(1.3, 0.0, 0.77, 3.0), bar(2.2, -0.2, 1.31, 0.2), wall(4.0)},
      30.0));
  all.push_back(row({bar(0.0, 1.0), bar(1.0, 0.5, 2.0, 7.0), bar(3.2, 0.5, 0.5, 0.1)}, 30.0));
  RowBar steel = bar(0.0, 10.0, 0.2), copper = bar(0.25, -3.0, 0.5);
  steel.youngs_modulus = 210e9, steel.density = 7800.0, steel.area = 1e-4;
  copper.youngs_modulus = 117e9, copper.density = 8930.0, copper.area = 3e-4;
  all.push_back(row({steel, copper}, 1e-1));
  return all;
}

TEST(BarRow, EnergyIsConservedAtAllTimes) {
  for (const BarRow& r : rows()) {
    double initial = 0.0;
    for (int b = 0; b < r.bars(); ++b) initial += r.total(b, 0.0);
    for (int i = 0; i < 997; ++i) {
      const double time = r.end() * i / 996.0;
      double now = 0.0;
      for (int b = 0; b < r.bars(); ++b) now += r.total(b, time);
      EXPECT_NEAR(now, initial, roundoff * initial) << "at " << time;
    }
  }
}

TEST(BarRow, MomentumChangesByTheImpulseOfTheForces) {
  for (const BarRow& r : rows()) {
    double scale = 0.0;
    for (int b = 0; b < r.bars(); ++b)
      if (!r.bar(b).wall) scale = std::max(scale, r.mass(b));
    for (int b = 0; b < r.bars(); ++b) {
      if (r.bar(b).wall || r.bar(b).fixed[1]) continue;
      double impulse = 0.0;
      for (const RowContact& contact : r.contacts())
        for (const BarEnd& e : contact.ends)
          if (e.bar == b) impulse -= e.normal() * contact.impulse();
      EXPECT_NEAR(r.momentum(b, r.end()) - r.momentum(b, 0.0), impulse, 10.0 * roundoff * scale);
    }
  }
}

TEST(BarRow, BodiesNeverOverlapAndPressedOnesMoveTogether) {
  for (const BarRow& r : rows()) {
    for (const RowContact& contact : r.contacts()) {
      for (int i = 0; i < 2000; ++i) {
        const double time = r.end() * (i + 0.37) / 2000.0;
        double gap = contact.initial_gap, parting = 0.0;
        for (const BarEnd& e : contact.ends) {
          gap -= e.normal() * r.displacement(e, time);
          parting -= e.normal() * r.velocity(e, time);
        }
        EXPECT_GE(gap, -10.0 * roundoff * r.end());
        if (!contact.closed(time)) continue;
        EXPECT_NEAR(gap, 0.0, 10.0 * roundoff * r.end());
        EXPECT_NEAR(parting, 0.0, 100.0 * roundoff);
      }
    }
  }
}

TEST(BarRow, WorkOfTheForcesIsTheGainInEnergy) {
  for (const BarRow& r : rows()) {
    for (int b = 0; b < r.bars(); ++b) {
      double work = 0.0;
      for (const RowContact& contact : r.contacts())
        for (const BarEnd& e : contact.ends)
          for (const RowContact::Stretch& s : contact.stretches)
            if (e.bar == b) work -= e.normal() * s.force * s.velocity * (s.end - s.begin);
      EXPECT_NEAR(r.total(b, r.end()) - r.total(b, 0.0), work, 100.0 * roundoff * r.total_peak(b));
    }
  }
}

TEST(BarRow, TheLargestEnergyIsThatOfTheWavesAtAllChanges) {
  for (const BarRow& r : rows()) {
    for (int b = 0; b < r.bars(); ++b) {
      double most = std::max(r.total(b, 0.0), r.total(b, r.end()));
      for (const RowContact& contact : r.contacts())
        for (const RowContact::Stretch& s : contact.stretches)
          most = std::max({most, r.total(b, s.begin), r.total(b, s.end)});
      EXPECT_NEAR(r.total_peak(b), most, 100.0 * roundoff * most);
    }
  }
}

/// Ten thousand echoes of a short heavy bar are under way in a long light one: to walk them all at
/// each of ten thousand changes takes half a minute.
TEST(BarRow, TheLargestEnergyOfManyWavesTakesNoTime) {
  RowBar hammer = bar(-1.0e-5, 1.0, 1.0e-5);
  hammer.area = 1000.0;
  const auto began = std::chrono::steady_clock::now();
  const BarRow r = row({hammer, bar(0.0, 0.0)}, 1.0);
  ASSERT_GT(r.contacts()[0].stretches.size(), 10'000u);
  const double energy = r.total(0, 0.0);
  EXPECT_NEAR(r.total_peak(0), energy, 1.0e-9 * energy);  // 1e4 changes of round-off each
  EXPECT_NEAR(r.total_peak(1), energy, 1.0e-9 * energy);  // all of it has gone over
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(5));  // takes 0.01 s
}

TEST(BarRow, ThatIsStillPressedWhenTheRunEndsSaysSo) {
  const BarRow r = pair(1.0, 1.0, 1.5);
  EXPECT_TRUE(r.contacts()[0].pressed_at_end);
  EXPECT_EQ(r.contacts()[0].end(), 1.5);
  EXPECT_NEAR(r.total(1, 1.5), 0.375, roundoff);
  EXPECT_FALSE(pair(1.0, 1.0, 2.5).contacts()[0].pressed_at_end);
}

std::string reason(const std::vector<RowBar>& bars, double end = 1.0) {
  try {
    row(bars, end);
  } catch (const InputError& error) {
    return error.what_is_wrong;
  }
  return "";
}

TEST(BarRow, RefusesWhatItCannotDescribe) {
  RowBar pulled = bar(1.0, 1.0), clamped = bar(1.0, 0.0), hollow = bar(1.0, 0.0);
  pulled.body_force = 9.81;
  clamped.fixed[0] = true;
  hollow.area = 0.0;
  RowBar endless = bar(1.0, 0.0);
  endless.youngs_modulus = 1e-300;
  endless.density = 1e300;
  const auto has = [](const std::string& text, const char* words) {
    return text.find(words) != std::string::npos;
  };
  EXPECT_TRUE(has(reason({bar(0.0, 0.0), pulled}), "a body force acts on bar"));
  EXPECT_TRUE(has(reason({bar(0.0, 0.0), clamped}), "the end of bar that meets another body"));
  EXPECT_TRUE(has(reason({bar(0.0, 0.0), hollow}), "not positive"));
  EXPECT_TRUE(has(reason({bar(0.0, 0.0), endless}), "beyond the range of numbers"));
  EXPECT_TRUE(has(reason({bar(0.5, 0.0), bar(1.0, 0.0)}), "overlap"));
  EXPECT_TRUE(has(reason({wall(0.0), wall(1.0)}), "both sides are walls"));
  EXPECT_THROW(BarRow({bar(0, 0), bar(1, 0)}, {{BarEnd{0, 1}, BarEnd{1, 1}}}, 0.0, 1.0),
               InputError);
  EXPECT_TRUE(has(reason({bar(0.0, 1.0), bar(1.0, 0.0, 1e-6)}, 1.0e6), "wave arrivals"));
}

}  // namespace
}  // namespace abut::test_bar_row
