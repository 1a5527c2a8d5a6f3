// Goal: the largest filtered force is that of the force in continuous time, however it is cut into
// stretches. Oracles: closed forms of means; the transfer function and the step response of a
// Butterworth filter of two poles that is run forward and backward.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "coordinator/record/channel_class_filter.hpp"
#include "coordinator/record/mean_filter.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::test_force_filter {
namespace {

// Sums of some thousand products of size 1.
constexpr double few = 1e-12;

using Corners = std::vector<std::pair<double, double>>;  // [s] [N], straight in between

/// Instants from the first corner to the last, these included, at distances from `low` to `high`.
std::vector<double> instants(const Corners& corners, double low, double high) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> length(low, high);
  std::vector<double> times;
  for (std::size_t k = 1; k < corners.size(); ++k) {
    for (double t = corners[k - 1].first; t < corners[k].first; t += length(random))
      times.push_back(t);
  }
  times.push_back(corners.back().first);
  return times;
}

double at(const Corners& corners, double time, std::size_t k) {
  const auto& [from, low] = corners[k - 1];
  const auto& [to, high] = corners[k];
  return low + (high - low) * (time - from) / (to - from);
}

/// Feeds the straight lines between corners, in substeps of changing length. Two corners at one
/// time are a jump.
template <class Filter>
double peak(Filter filter, const Corners& corners, double low, double high) {
  const std::vector<double> times = instants(corners, low, high);
  std::size_t k = 1;
  for (std::size_t i = 1; i < times.size(); ++i) {
    while (corners[k].first <= times[i - 1]) ++k;
    filter.add(times[i - 1], times[i], at(corners, times[i - 1], k), at(corners, times[i], k));
  }
  return filter.peak();
}

TEST(MeanFilter, HasTheClosedFormsOfStepsRampsAndTriangles) {
  struct Case {
    const char* what;
    Corners corners;
    double time, expected;
  };
  const std::vector<Case> cases = {
      {"step", {{0, 3}, {2, 3}}, 0.5, 3.0},
      {"step of just the time", {{0, 3}, {0.5, 3}}, 0.5, 3.0},
      {"short pulse", {{0, 3}, {0.2, 3}, {0.2, 0}, {4, 0}}, 0.5, 3.0 * 0.2 / 0.5},
      {"ramp", {{0, 0}, {2, 4}}, 0.5, 4.0 * (2.0 - 0.25) / 2.0},
      {"triangle", {{0, 0}, {1, 1}, {2, 0}}, 0.5, 1.0 - 0.5 / 4.0},  // between corners
      {"lopsided triangle", {{0, 0}, {0.5, 1}, {2, 0}}, 0.5, 1.0 - 0.5 / 4.0},
      {"overshoot", {{0, 1.5}, {0.1, 1.5}, {0.1, 1}, {2, 1}}, 0.5, 1.1},
      {"pull", {{0, -1}, {1, -1}}, 0.5, 0.0},
      {"two pulses",
       {{0, 1}, {0.1, 1}, {0.1, 0}, {0.3, 0}, {0.3, 2}, {0.4, 2}, {0.4, 0}, {2, 0}},
       0.5,
       0.3 / 0.5},
  };
  for (const Case& c : cases) {
    for (const double substep : {0.001, 0.013, 0.7, 100.0})
      EXPECT_NEAR(peak(MeanFilter(c.time), c.corners, 0.2 * substep, substep), c.expected, few)
          << c.what << " in substeps of " << substep;
  }
}

TEST(MeanFilter, TimeLeftOutIsWithoutForce) {
  MeanFilter filter(0.5);
  filter.add(0.0, 0.3, 1.0, 1.0);
  filter.add(0.4, 0.6, 1.0, 1.0);
  EXPECT_NEAR(filter.peak(), 0.4 / 0.5, few);
}

TEST(MeanFilter, HoldsBoundedMemoryAndItsDigitsOverManySubsteps) {
  MeanFilter filter(1.0);
  const int substeps = 2'000'000;
  const double length = 2.0e-6;  // half a million in the time, 4 s in all
  std::size_t most = 0;
  for (int i = 0; i < substeps; ++i) {
    const double force = i % 2 == 0 ? 1.28 : 0.72;  // chatter about 1
    filter.add(i * length, (i + 1) * length, force, force);
    most = std::max(most, filter.held());
  }
  EXPECT_LE(most, 65538u);
  // One of 65536 gathered stretches may hold one substep more of the higher force.
  EXPECT_NEAR(filter.peak(), 1.0, 0.28 * 2.0 / 65536.0);
}

/// Frequency of the transfer function's two poles [rad/s].
double cut_off(int channel_class) { return 2.0 * std::numbers::pi * 2.0775 * channel_class; }

class ChannelClass : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Record, ChannelClass, testing::Values(60, 180, 600, 1000));

TEST_P(ChannelClass, SineComesOutWithTheSquareOfTheFilter) {
  // 1 / (1 + (w / wd)^4); 3 dB less at 0.8022 wd, which is the 1.667 times the class of the norm.
  for (const double share : {0.1, 0.5, 0.80223, 1.0, 2.0, 5.0}) {
    const double w = share * cut_off(GetParam());
    const double gain = 1.0 / (1.0 + std::pow(share, 4));
    for (const int substeps : {97, 1001}) {  // in a period
      const double length = 2.0 * std::numbers::pi / w / substeps;
      ChannelClassFilter filter(GetParam());
      // It sets in over 20 periods with three continuous derivatives, and goes so: jumps of the
      // fourth are all that passes besides.
      const double jumps = 840.0 / std::pow(40.0 * std::numbers::pi, 4);
      const double periods = 60.0;
      auto force = [w, periods](double t) {
        const double x = w * t / (2.0 * std::numbers::pi * periods);
        const double r = std::clamp(3.0 * std::min(x, 1.0 - x), 0.0, 1.0);
        const double rise = std::pow(r, 4) * (35.0 + r * (-84.0 + r * (70.0 - 20.0 * r)));
        return rise * std::sin(w * t);
      };
      for (int i = 0; i < periods * substeps; ++i)
        filter.add(i * length, (i + 1) * length, force(i * length), force((i + 1) * length));
      // Means over a sample lose (w T)^2 / 24, the bilinear map's warp four times (w T)^2 / 12, the
      // sample beside the crest (w T)^2 / 8; straight lines between substeps of phase p p^2 / 12.
      const double sampling = std::pow(w * 1e-3 / GetParam(), 2);
      const double lines = std::pow(2.0 * std::numbers::pi / substeps, 2) / 12.0;
      EXPECT_NEAR(filter.peak(), gain, gain * (0.6 * sampling + lines) + 2.0 * jumps) << share;
    }
  }
}

TEST_P(ChannelClass, PulseComesOutAsTheStepResponseSays) {
  // The step response is 1 - exp(-at) cos(at) / 2, a = wd / sqrt 2: a pulse of length d is largest
  // in its middle while a d is below 2 pi, 1 - exp(-ad/2) cos(ad/2); a long step overshoots by
  // exp(-3 pi / 4) / sqrt 8.
  const double a = cut_off(GetParam()) / std::numbers::sqrt2;
  for (const double ad : {0.05, 0.5, 2.0, 4.6}) {
    const double d = ad / a;
    const double expected = 1.0 - std::exp(-0.5 * ad) * std::cos(0.5 * ad);
    for (const double substep : {0.003, 0.2, 5.0}) {
      const double found = peak(ChannelClassFilter(GetParam()), {{0.1, 1.0}, {0.1 + d, 1.0}},
                                0.5 * substep * d, substep * d);
      // A sample is 1.3e-2 / wd long and its phase in the pulse is any: 1e-5 of the crest's height
      // by (wd T)^2 / 24 and as much by the crest between two samples.
      EXPECT_NEAR(found, expected, 3e-5) << ad;
    }
  }
  const double longer = 300.0 / a;  // 13000 samples: the backward run starts anew in it
  EXPECT_NEAR(peak(ChannelClassFilter(GetParam()), {{0.1, 1.0}, {0.1 + longer, 1.0}}, 1e-3 * longer,
                   2e-3 * longer),
              1.0 + std::exp(-0.75 * std::numbers::pi) / std::sqrt(8.0), 3e-5);
}

TEST_P(ChannelClass, StretchesInOneCallOrManyAreTheSame) {
  const Corners corners = {{0, 0}, {0.01, 1}, {0.013, 0.2}, {0.02, 0.7}, {0.021, 0}};
  const double whole = peak(ChannelClassFilter(GetParam()), corners, 1.0, 1.0);
  for (const double substep : {1e-5, 1e-4, 1.3e-3})
    EXPECT_NEAR(peak(ChannelClassFilter(GetParam()), corners, 0.5 * substep, substep), whole, few);
}

TEST_P(ChannelClass, ContactsFarApartAreFilteredOnTheirOwn) {
  const double d = 1.0 / cut_off(GetParam());
  const double alone = peak(ChannelClassFilter(GetParam()), {{0.0, 2.0}, {d, 2.0}}, d, d);
  ChannelClassFilter filter(GetParam());
  double time = 0.0;
  for (const double force : {1.0, 2.0, 1.5}) {
    filter.add(time, time + d, force, force);
    filter.add(time + d, time + 1.0e4, 0.0, 0.0);  // up to 1e7 samples, of no cost
    time += 2.0e4;
    EXPECT_EQ(filter.held(), 0u);
  }
  // Times of 4e4 s hold the pulse's length of 1e-4 s to 1e-7 of it.
  EXPECT_NEAR(filter.peak(), alone, 5.0e-7);
}

TEST_P(ChannelClass, HoldsBoundedMemory) {
  ChannelClassFilter filter(GetParam());
  const double length = 1.0e-3 / GetParam() / 7.3;
  std::size_t most = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    filter.add(i * length, (i + 1) * length, 1.0, 1.0);
    most = std::max(most, filter.held());
  }
  EXPECT_LE(most, 9000u);
  EXPECT_NEAR(filter.peak(), 1.0 + std::exp(-0.75 * std::numbers::pi) / std::sqrt(8.0), 3e-5);
}

}  // namespace
}  // namespace abut::test_force_filter
