// Goal: all who divide a window divide it alike, by the rule of the contract. Oracles: the rule in
// words.

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "contract/substeps.hpp"
#include "tests/support/tolerance.hpp"

namespace abut {
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
}  // namespace abut
