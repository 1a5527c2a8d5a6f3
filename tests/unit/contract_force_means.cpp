// Goal: a body takes a force that is linear between other times with its whole impulse.
// Oracles: parts sum to 1 at every level; the impulse by the levels' dual cells is that of the
// linear force; its own times are taken as they are; Waveform tells the same means.

#include <vector>

#include <gtest/gtest.h>

#include "contract/force_means.hpp"
#include "contract/waveform.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::contract_force_means_tests {
namespace {

std::vector<double> levels(double begin, double end, int parts) {
  std::vector<double> out;
  for (int i = 0; i <= parts; ++i)
    out.push_back(i == parts ? end : begin + i * (end - begin) / parts);
  return out;
}

TEST(ForceMeans, KeepTheImpulse) {
  for (const int here : {1, 2, 3, 7, 20}) {
    for (const int there : {1, 2, 3, 5, 20, 60}) {
      const std::vector<double> own = levels(0.3, 1.1, here), source = levels(0.3, 1.1, there);
      const std::vector<double> parts = force_means(own, source);
      Waveform force(1);
      force.support = ForceSupport::linear;
      force.time = source;
      for (std::size_t j = 0; j < source.size(); ++j)
        force.f.push_back(1.0 + 0.7 * static_cast<double>(j * j % 5));
      double impulse = 0.0, whole = 0.0;
      for (std::size_t b = 0; b < own.size(); ++b) {
        double sum = 0.0, mean = 0.0;
        for (std::size_t j = 0; j < source.size(); ++j) {
          sum += parts[b * source.size() + j];
          mean += parts[b * source.size() + j] * force.f[j];
        }
        EXPECT_NEAR(sum, 1.0, roundoff(2.0 * static_cast<double>(source.size()), 1.0));
        const double from = b == 0 ? own[0] : 0.5 * (own[b - 1] + own[b]);
        const double to = b + 1 == own.size() ? own[b] : 0.5 * (own[b] + own[b + 1]);
        if (here != there) {
          double told = 0.0;
          force.impulse(from, to, {&told, 1});
          EXPECT_NEAR(mean * (to - from), told, roundoff(static_cast<double>(source.size()), 3.8));
        }
        impulse += mean * (to - from);
      }
      force.impulse(0.3, 1.1, {&whole, 1});
      EXPECT_NEAR(impulse, whole, roundoff(static_cast<double>(here + there), 3.8))
          << here << " of " << there;
    }
  }
}

TEST(ForceMeans, OfTheSameTimesAreTheValues) {
  const std::vector<double> own = levels(0.0, 1.0, 3);
  const std::vector<double> parts = force_means(own, own);
  for (std::size_t b = 0; b < 4; ++b)
    for (std::size_t j = 0; j < 4; ++j) EXPECT_EQ(parts[b * 4 + j], b == j ? 1.0 : 0.0);
}

TEST(LinearForce, IsLinearBetweenItsTimes) {
  Waveform force(2);
  force.support = ForceSupport::linear;
  force.time = {0.0, 1.0, 3.0};
  force.f = {0.0, 1.0, 2.0, 1.0, 0.0, 1.0};
  std::vector<double> out(2);
  force.force_at(2.0, out);
  EXPECT_EQ(out, (std::vector<double>{1.0, 1.0}));
  force.impulse(0.5, 2.0, out);
  EXPECT_DOUBLE_EQ(out[0], 0.5 * 1.5 + 1.5);  // trapezia of 0.5 and 1 s
  EXPECT_DOUBLE_EQ(out[1], 1.5);
}

}  // namespace
}  // namespace abut::contract_force_means_tests
