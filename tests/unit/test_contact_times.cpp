// Goal: contacts are counted and timed from events alone. Oracle: mental arithmetic.
#include <gtest/gtest.h>

#include "coordinator/record/contact_times.hpp"

namespace abut::test_contact_times {
namespace {

TEST(ContactTimes, EveryReleaseCountsWhereNothingIsKnownOfTheMesh) {
  ContactTimes times(0.0);
  EXPECT_TRUE(times.is_open());
  EXPECT_EQ(times.closed(10.0), 0.0);
  times.close(1.0);
  EXPECT_EQ(times.closed(3.0), 2.0);
  times.open(3.0);
  times.close(3.0);  // at once
  times.open(4.0);
  EXPECT_EQ(times.count(), 2);
  EXPECT_EQ(times.begin(), 1.0);
  EXPECT_EQ(times.end(), 4.0);
  EXPECT_EQ(times.closed(10.0), 3.0);
}

TEST(ContactTimes, AReleaseTooShortForTheMeshIsNone) {
  ContactTimes times(0.5);
  times.close(1.0);
  times.open(2.0);
  EXPECT_TRUE(times.goes_on(2.25));
  EXPECT_FALSE(times.goes_on(2.5));
  times.close(2.25);
  EXPECT_EQ(times.count(), 1);
  times.open(3.0);
  EXPECT_EQ(times.closed(9.0), 2.0);  // from 1 to 3
  times.close(3.5);
  EXPECT_EQ(times.count(), 2);
  times.open(4.0);
  EXPECT_EQ(times.closings(), 3);
  EXPECT_EQ(times.closed(9.0), 2.5);
  EXPECT_EQ(times.begin(), 1.0);
  EXPECT_EQ(times.end(), 4.0);
}

TEST(ContactTimes, EventsThatRepeatOrCrossWithinASubstepLoseNoTime) {
  ContactTimes times(0.0);
  times.open(0.5);  // was open
  times.close(1.0);
  times.close(1.5);  // was closed
  times.open(2.0);
  times.close(1.9);  // located before the release
  times.open(3.0);
  EXPECT_EQ(times.count(), 2);
  EXPECT_EQ(times.closings(), 2);
  EXPECT_EQ(times.closed(9.0), 2.0);
}

TEST(ContactTimes, ATieIsClosedAndNeverCounts) {
  ContactTimes times(1.0);
  times.join(-1.0);
  EXPECT_FALSE(times.is_open());
  EXPECT_EQ(times.count(), 0);
  EXPECT_EQ(times.closed(3.0), 4.0);
}

}  // namespace
}  // namespace abut::test_contact_times
