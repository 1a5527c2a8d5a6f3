// Goal: contacts are what the force does. Oracle: mental arithmetic.
#include <gtest/gtest.h>

#include <vector>

#include "coordinator/record/pushes.hpp"

namespace abut::test_pushes {
namespace {

/// A push of a constant force, cut into parts.
void push(Pushes& pushes, double from, double to, double force, int parts = 4) {
  for (int k = 0; k < parts; ++k)
    pushes.add(from + (to - from) * k / parts, from + (to - from) * (k + 1) / parts, force, force);
}

TEST(Pushes, AreFromNothingToNothing) {
  Pushes pushes(0.0);
  EXPECT_FALSE(pushes.any());
  EXPECT_EQ(pushes.count(), 0);
  pushes.add(0.0, 1.0, 0.0, 0.0);
  pushes.add(1.0, 2.0, -1.0, 0.0);  // a pull is none
  EXPECT_FALSE(pushes.any());
  push(pushes, 2.0, 3.0, 5.0);
  pushes.add(3.0, 4.0, 0.0, 0.0);
  push(pushes, 4.0, 5.0, 5.0);
  EXPECT_EQ(pushes.count(), 2);
}

TEST(Pushes, ThatFollowAtOnceAreOne) {
  Pushes pushes(0.5);
  push(pushes, 0.0, 1.0, 5.0);
  push(pushes, 1.4, 2.0, 5.0);
  EXPECT_EQ(pushes.count(), 1);
  push(pushes, 2.6, 3.0, 5.0);
  EXPECT_EQ(pushes.count(), 2);
}

/// Whatever comes first, and however it is cut.
TEST(Pushes, OfHardlyAnyImpulseAreTouches) {
  for (const int parts : {1, 7, 100}) {
    for (const double small : {1.0e-12, 1.0e-4, 9.0e-3, 1.1e-2, 0.5}) {
      for (const bool small_first : {false, true}) {
        Pushes pushes(0.1);
        push(pushes, 0.0, 1.0, small_first ? small : 1.0, parts);
        push(pushes, 2.0, 3.0, small_first ? 1.0 : small, parts);
        EXPECT_EQ(pushes.count(), small > 1.0e-2 ? 2 : 1) << small << " " << small_first;
      }
    }
  }
}

/// What an iteration leaves open between two pushes joins them to nothing.
TEST(Pushes, AreNotJoinedByRounding) {
  Pushes pushes(0.1);
  push(pushes, 0.0, 1.0, 1.0);
  push(pushes, 1.0, 2.0, 1.0e-9);
  push(pushes, 2.0, 3.0, 1.0);
  EXPECT_EQ(pushes.count(), 2);
}

}  // namespace
}  // namespace abut::test_pushes
