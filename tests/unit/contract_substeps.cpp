// Goal: all who divide a window divide it alike, by the rule of the contract. Oracles: the rule in
// words.

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "contract/substeps.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::contract_substeps_tests {
namespace {

TEST(Substeps, AreWholeStepsThatEndOnTheWindowsEnd) {
  const Substeps s = Substeps::divide(0.3, 0.7, 0.1);
  EXPECT_EQ(s.count, 4);
  EXPECT_EQ(s.time(0), 0.3);
  EXPECT_EQ(s.time(4), 0.7);  // not 0.3 + 4 * 0.1, which is another number
  EXPECT_EQ(s.length(4), 0.1);
}

TEST(Substeps, TheLastOneIsShorterWhereTheyDoNotFillTheWindow) {
  const Substeps s = Substeps::divide(0.0, 1.0, 0.3);
  EXPECT_EQ(s.count, 4);
  EXPECT_EQ(s.length(3), 0.3);
  EXPECT_NEAR(s.length(4), 0.1, roundoff(4, 1.0));
  EXPECT_EQ(s.time(4), 1.0);
}

TEST(Substeps, ARemainderThatIsRoundingIsNoStepOfItsOwn) {
  for (double excess : {-1e-8, 1e-8}) {
    const Substeps s = Substeps::divide(0.0, 1.0 + excess, 0.25);
    EXPECT_EQ(s.count, 4) << excess;
    EXPECT_EQ(s.length(4), 0.25) << "whole to the last bit: factors and kernels are used again";
    EXPECT_EQ(s.time(4), 1.0 + excess);
  }
}

TEST(Substeps, OfABodyWithoutAStepAreOne) {
  const Substeps s = Substeps::divide(1.0, 3.0, 0.0);
  EXPECT_EQ(s.count, 1);
  EXPECT_EQ(s.length(1), 2.0);
}

TEST(Substeps, OfAWindowOfNoLengthAreNone) {
  EXPECT_EQ(Substeps::divide(1.0, 1.0, 0.1).count, 0);
  EXPECT_EQ(Substeps::divide(1.0, 1.0, 0.0).count, 0);
}

/// Loads that depend on time act in a flight as they do window by window, to the last bit.
TEST(Substeps, OfSeveralWindowsInARowAreThoseOfEachAlone) {
  const double anchor = 0.1, whole = 0.7 / 3.0;
  const auto stop = [&](std::int64_t k) { return anchor + static_cast<double>(4 + k) * whole; };
  const TimeWindow row{4, stop(0), stop(5), 5, 4, anchor, whole};
  for (const double step : {whole / 7.0, whole / 2.5, 3.0 * whole, 0.0}) {
    const Substeps all = Substeps::divide(row, step, 3);
    int i = 0;
    for (std::int64_t k = 0; k < 5; ++k) {
      const Substeps one = Substeps::divide({4 + k, stop(k), stop(k + 1)}, step, 3);
      for (int j = 1; j <= one.count; ++j) {
        ++i;
        EXPECT_EQ(all.time(i), one.time(j)) << step << ' ' << i;
        EXPECT_EQ(all.length(i), one.length(j)) << step << ' ' << i;
      }
    }
    EXPECT_EQ(all.count, i) << step;
  }
}

TEST(Substeps, MoreThanCanBeNumberedAreRefused) {
  EXPECT_THROW(Substeps::divide(0.0, 1.0, 1e-12), RunError);
}

TEST(Substeps, KnowTheirOwnTimes) {
  const Substeps s = Substeps::divide(0.0, 1.0, 0.25);
  EXPECT_TRUE(s.matches({0.0, 0.25, 0.5, 0.75, 1.0}));
  EXPECT_FALSE(s.matches({0.0, 0.25, 0.5, 1.0}));
  EXPECT_FALSE(s.matches({0.0, 0.25, 0.5, 0.75, 1.0 + std::numeric_limits<double>::epsilon()}));
}

}  // namespace
}  // namespace abut::contract_substeps_tests
