// Goal: numbers below full precision are zero while asked for, in threads too, and only then.
// Oracle: the smallest normal number, halved.

#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include "base/denormals.hpp"

namespace abut::test_denormals {
namespace {

double halved() {
  volatile double smallest = std::numeric_limits<double>::min();
  return smallest * 0.5;
}

TEST(Denormals, AreZeroWhileFlushedAndInThreadsThatBeginThen) {
#if !defined(__SSE2__) && !defined(__aarch64__)
  GTEST_SKIP() << "this processor has no switch for them";
#endif
  EXPECT_GT(halved(), 0.0);
  {
    const FlushedDenormals flushed;
    EXPECT_EQ(halved(), 0.0);
    double elsewhere = 1.0;
    std::thread([&elsewhere] { elsewhere = halved(); }).join();
    EXPECT_EQ(elsewhere, 0.0);
  }
  EXPECT_GT(halved(), 0.0);
}

}  // namespace
}  // namespace abut::test_denormals
