// Goal: what a run will take follows from what its first windows took. Oracle: made-up probes whose
// runs are known.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "coordinator/prediction.hpp"
#include "coordinator/record/shares.hpp"
#include "coordinator/record/time_words.hpp"

namespace abut::test_prediction {
namespace {

/// Windows of 1 s of the scene's time, after a start that costs nothing.
ProbedRun probe_of(std::vector<ProbedRun::Stretch> stretches) {
  ProbedRun probe;
  probe.stretches = std::move(stretches);
  for (const ProbedRun::Stretch& s : probe.stretches) {
    probe.reached += s.length;
    probe.wall += s.wall;
  }
  return probe;
}

ProbedRun::Stretch free_window(double wall) { return {1.0, wall, false, 1}; }
ProbedRun::Stretch closed_window(double wall, int iterations) {
  return {1.0, wall, true, iterations};
}

constexpr double rounding = 1.0e-12;  // of a few sums and products

TEST(Prediction, IsExactWhereTheProbeIsTheRun) {
  ProbedRun probe = probe_of({free_window(0.25)});
  probe.whole = true;
  const std::optional<Prediction> out = predict(probe, 1.0, 0.5, {});
  ASSERT_TRUE(out);
  EXPECT_TRUE(out->exact);
  EXPECT_DOUBLE_EQ(out->seconds, 0.75);
}

TEST(Prediction, IsNoneBeforeAWindowHasEnded) {
  EXPECT_FALSE(predict(probe_of({}), 1.0, 0.5, {.possible = true}));
}

/// Early windows, which make kernels, do not count for later ones.
TEST(Prediction, OfWhatNothingTouchesGoesOnAsInTheLastHalf) {
  const ProbedRun probe = probe_of({free_window(0.9), free_window(0.1), free_window(0.1),
                                    free_window(0.1), free_window(0.1), free_window(0.1),
                                    free_window(0.1), free_window(0.1), free_window(0.1)});
  const std::optional<Prediction> out = predict(probe, 109.0, 1.0, {});
  ASSERT_TRUE(out);
  EXPECT_NEAR(out->seconds, 1.0 + 1.7 + 100 * 0.1, rounding * 100);
  EXPECT_EQ(out->low, out->high);
}

/// Of 98 s to come a state of fields is written every 2 s; one that takes long is named.
TEST(Prediction, CountsTheWritingOfFields) {
  ProbedRun probe = probe_of({free_window(0.1), free_window(0.1)});
  probe.state_wall = 0.5;
  probe.states_apart = 2.0;
  const std::optional<Prediction> out = predict(probe, 100.0, 0.0, {});
  ASSERT_TRUE(out);
  EXPECT_NEAR(out->seconds, 0.2 + 98 * 0.1 + 49 * 0.5, rounding * 100);
  EXPECT_NE(to_text(*out, probe, 100.0, 1.0, 1).find("fields     about 25 s"), std::string::npos);
  probe.state_wall = 1.0e-3;
  const std::optional<Prediction> quick = predict(probe, 100.0, 0.0, {});
  EXPECT_EQ(to_text(*quick, probe, 100.0, 1.0, 1).find("fields"), std::string::npos);
}

TEST(Prediction, LiesBetweenContactForNoTimeAndForAllTime) {
  const ProbedRun probe =
      probe_of({free_window(0.1), free_window(0.1), closed_window(0.4, 2), closed_window(0.4, 2)});
  const std::optional<Prediction> out = predict(probe, 104.0, 0.0, {.possible = true, .sweeps = 3});
  ASSERT_TRUE(out);
  EXPECT_NEAR(out->low, 1.0 + 10.0, rounding * 100);
  EXPECT_NEAR(out->high, 1.0 + 40.0, rounding * 100);
  EXPECT_NEAR(out->seconds, std::sqrt(out->low * out->high), rounding * 100);
}

TEST(Prediction, OfContactThatLastsIsThatOfContact) {
  const ProbedRun probe =
      probe_of({free_window(0.1), closed_window(0.4, 2), closed_window(0.4, 2)});
  const std::optional<Prediction> out =
      predict(probe, 103.0, 0.0, {.possible = true, .lasting = true, .sweeps = 3});
  ASSERT_TRUE(out);
  EXPECT_NEAR(out->seconds, 0.9 + 40.0, rounding * 100);
}

TEST(Prediction, GuessesContactThatHasNotComeFromItsIterations) {
  const ProbedRun probe = probe_of({free_window(0.1), free_window(0.1)});
  const std::optional<Prediction> out = predict(probe, 102.0, 0.0, {.possible = true, .sweeps = 3});
  ASSERT_TRUE(out);
  EXPECT_NEAR(out->low, 0.2 + 10.0, rounding * 100);
  EXPECT_NEAR(out->high, 0.2 + 30.0, rounding * 100);
}

TEST(Prediction, NamesWhatIsDear) {
  ProbedRun probe = probe_of({free_window(2.0)});
  probe.waited_seconds = {0.2, 1.4};
  const std::vector<std::string> names = {"ball", "plate"};
  EXPECT_EQ(dear_words(probe, names), "plate 70 %, ball 10 %, coupling 20 %");
}

TEST(Shares, OfManyBodiesAreTheLargestAndTheOthers) {
  const std::vector<std::string> names = {"a", "b", "c", "d"};
  EXPECT_EQ(shares_words(shares_of(std::vector<double>{1.0, 4.0, 2.0, 1.0}, 10.0), names, 2),
            "b 40 %, c 20 %, 2 others 20 %, coupling 20 %");
  EXPECT_EQ(shares_words(shares_of(std::vector<double>{1.0, 97.0, 2.0, 0.0}, 100.0), names, 2),
            "b 97 %, 3 others 3 %, coupling 0 %");
  EXPECT_EQ(shares_words(shares_of(std::vector<double>{1.0, 1.0, 2.0, 2.0}, 100.0), names, 2),
            "4 bodies 6 %, coupling 94 %");
  EXPECT_EQ(shares_words(shares_of(std::vector<double>{0.0}, 0.0), std::vector<std::string>{"a"}),
            "a 0 %, coupling 0 %");
}

TEST(TimeWords, HaveTwoFiguresOrTwoUnits) {
  EXPECT_EQ(time_words(0.0123), "0.012 s");
  EXPECT_EQ(time_words(3.44), "3.4 s");
  EXPECT_EQ(time_words(14.4), "14 s");
  EXPECT_EQ(time_words(200.0), "3 min 20 s");
  EXPECT_EQ(time_words(119.7), "2 min 0 s");
  EXPECT_EQ(time_words(5.0 * 3600.0 + 620.0), "5 h 10 min");
  EXPECT_EQ(time_words(3.0 * 86400.0 + 4.1 * 3600.0), "3 d 4 h");
}

}  // namespace
}  // namespace abut::test_prediction
