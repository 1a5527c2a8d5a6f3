// Goal: a waveform gives back what was stored, and hands impulses on without loss.
// Oracle: identities of interpolation and of additive integrals.

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "contract/outcome.hpp"
#include "contract/waveform.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::contract_waveform_tests {
namespace {

Waveform uneven(ForceSupport support) {
  Waveform w;
  w.support = support;
  w.time = {1.0, 1.1, 1.15, 1.4, 2.0};
  w.u = {0.3, -0.7, 1.0 / 3.0, 1e-12, 5.0};
  w.f = {2.0, -1.0, 7.0, 0.5, 3.0};
  return w;
}

double value(const Waveform& w, const std::vector<double>& field, double at) {
  double out = 0.0;
  w.interpolate(field, at, {&out, 1});
  return out;
}

double force(const Waveform& w, double at) {
  double out = 0.0;
  w.force_at(at, {&out, 1});
  return out;
}

double impulse(const Waveform& w, double from, double to) {
  double out = 0.0;
  w.impulse(from, to, {&out, 1});
  return out;
}

TEST(Waveform, InterpolationIsExactAtStoredTimes) {
  const Waveform w = uneven(ForceSupport::nodal);
  for (std::size_t i = 0; i < w.size(); ++i) EXPECT_EQ(value(w, w.u, w.time[i]), w.u[i]);
}

TEST(Waveform, InterpolationIsLinearBetweenAndConstantOutside) {
  const Waveform w = uneven(ForceSupport::nodal);
  // one division and one product
  EXPECT_NEAR(value(w, w.u, 1.7), 0.5 * (w.u[3] + w.u[4]), roundoff(4, 5.0));
  EXPECT_EQ(value(w, w.u, 0.0), w.u.front());
  EXPECT_EQ(value(w, w.u, 3.0), w.u.back());
}

TEST(Waveform, OneStoredTimeIsAConstant) {
  Waveform w;
  w.time = {2.0};
  w.u = {4.0};
  w.f = {3.0};
  for (double at : {1.0, 2.0, 3.0}) EXPECT_EQ(value(w, w.u, at), 4.0);
  EXPECT_EQ(force(w, 2.0), 3.0);
  EXPECT_EQ(impulse(w, 1.0, 3.0), 0.0);  // no time passes
}

TEST(Waveform, SeveralValuesPerTimeStayApart) {
  Waveform w(2);
  w.time = {0.0, 1.0};
  w.u = {1.0, 10.0, 3.0, 30.0};
  w.f = {2.0, 4.0, 2.0, 4.0};
  double out[2] = {};
  w.interpolate(w.u, 0.5, out);
  EXPECT_EQ(out[0], 2.0);
  EXPECT_EQ(out[1], 20.0);
  w.impulse(0.25, 0.75, out);
  EXPECT_EQ(out[0], 1.0);
  EXPECT_EQ(out[1], 2.0);
}

TEST(Waveform, ForceOfAStepBelongsToTheSubstepThatEndsThere) {
  const Waveform w = uneven(ForceSupport::step);
  EXPECT_EQ(force(w, 1.05), w.f[1]);
  EXPECT_EQ(force(w, 1.1), w.f[1]);
  EXPECT_EQ(force(w, 1.1000001), w.f[2]);
  EXPECT_EQ(force(w, 2.0), w.f[4]);
  EXPECT_EQ(force(w, 1.0), w.f[1]);  // the window's begin has no substep of its own
  EXPECT_EQ(force(w, 5.0), w.f[4]);
}

TEST(Waveform, TotalImpulseOfNodalForcesIsTheTrapezoidSum) {
  const Waveform w = uneven(ForceSupport::nodal);
  double sum = 0.0;
  for (std::size_t i = 1; i < w.size(); ++i)
    sum += 0.5 * (w.f[i - 1] + w.f[i]) * (w.time[i] - w.time[i - 1]);
  EXPECT_NEAR(impulse(w, 1.0, 2.0), sum, roundoff(20, 7.0));  // 5 terms of a few roundings each
}

TEST(Waveform, TotalImpulseOfStepForcesIsTheirSum) {
  const Waveform w = uneven(ForceSupport::step);
  double sum = 0.0;
  for (std::size_t i = 1; i < w.size(); ++i) sum += w.f[i] * (w.time[i] - w.time[i - 1]);
  EXPECT_NEAR(impulse(w, 1.0, 2.0), sum, roundoff(20, 7.0));
}

class BothSupports : public testing::TestWithParam<ForceSupport> {};
INSTANTIATE_TEST_SUITE_P(Waveform, BothSupports,
                         testing::Values(ForceSupport::nodal, ForceSupport::step));

TEST_P(BothSupports, ImpulsesOfAdjoiningIntervalsAddUp) {
  const Waveform w = uneven(GetParam());
  for (int pieces : {2, 3, 7, 64}) {
    double sum = 0.0;
    for (int i = 0; i < pieces; ++i)
      sum += impulse(w, 1.0 + double(i) / pieces, 1.0 + double(i + 1) / pieces);
    EXPECT_NEAR(sum, impulse(w, 1.0, 2.0), roundoff(20 + 4 * pieces, 7.0)) << pieces;
  }
}

TEST_P(BothSupports, ImpulseOutsideTheWindowIsNothing) {
  const Waveform w = uneven(GetParam());
  EXPECT_EQ(impulse(w, 0.0, 1.0), 0.0);
  EXPECT_EQ(impulse(w, 2.0, 3.0), 0.0);
  EXPECT_EQ(impulse(w, 1.3, 1.3), 0.0);
  EXPECT_EQ(impulse(w, 0.0, 9.0), impulse(w, 1.0, 2.0));
}

TEST_P(BothSupports, ImpulseOfAConstantForceIsForceTimesTime) {
  Waveform w = uneven(GetParam());
  w.f.assign(w.size(), 4.0);
  EXPECT_NEAR(impulse(w, 1.12, 1.87), 4.0 * 0.75, roundoff(30, 4.0));
}

TEST(Waveform, ClearForgetsValues) {
  Waveform w = uneven(ForceSupport::nodal);
  w.clear();
  EXPECT_TRUE(w.empty());
  EXPECT_TRUE(w.f.empty());
}

TEST(Waveform, TellsNoMoreValuesThanItHasRoomFor) {
  // A width above the room of the reader was written behind it once.
  Waveform w = uneven(ForceSupport::nodal);
  w.width = 2;
  w.u.assign(2 * w.size(), 1.0);
  w.f = w.u;
  std::array<double, 1> room{};
  EXPECT_DEATH(w.interpolate(w.u, 1.5, room), "");
  EXPECT_DEATH(w.force_at(1.5, room), "");
  EXPECT_DEATH(w.impulse(1.2, 1.5, room), "");
}

TEST(Outcome, EveryCauseHasItsWords) {
  EXPECT_STREQ(to_string(Failed::Cause::non_finite), "non-finite state");
  EXPECT_STREQ(to_string(Failed::Cause::no_convergence), "no convergence");
}

}  // namespace
}  // namespace abut::contract_waveform_tests
