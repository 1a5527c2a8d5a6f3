// Goal: a hook is called while its caller is busy, never after the end, and what it throws reaches
// the caller.
// Oracle: counts and identities of threads; only that calls come is asked, not how many: a loaded
// machine may delay any of them.

#include <atomic>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "base/life_signs.hpp"

namespace abut::test_life_signs {
namespace {

using std::chrono::milliseconds;

TEST(LifeSigns, ComeWhileTheCallerIsBusyAndNotAfter) {
  std::atomic<int> calls{0};
  std::atomic<bool> other{true};
  const std::thread::id here = std::this_thread::get_id();
  LifeSigns life(
      [&] {
        ++calls;
        if (std::this_thread::get_id() == here) other = false;
      },
      milliseconds(1));
  while (calls < 3) std::this_thread::sleep_for(milliseconds(1));
  life.end();
  const int then = calls;
  std::this_thread::sleep_for(milliseconds(20));
  EXPECT_EQ(calls, then);
  EXPECT_TRUE(other);
}

TEST(LifeSigns, WhatTheHookThrowsIsThrownAtTheEndAndOnce) {
  std::atomic<int> calls{0};
  LifeSigns life(
      [&] {
        ++calls;
        throw std::runtime_error("interrupted");
      },
      milliseconds(1));
  while (calls < 1) std::this_thread::sleep_for(milliseconds(1));
  std::this_thread::sleep_for(milliseconds(20));
  EXPECT_EQ(calls, 1);
  EXPECT_THROW(life.end(), std::runtime_error);
  EXPECT_NO_THROW(life.end());
}

TEST(LifeSigns, AShortCallMakesNone) {
  std::atomic<int> calls{0};
  {
    LifeSigns life([&] { ++calls; }, milliseconds(60'000));
  }
  EXPECT_EQ(calls, 0);
}

}  // namespace
}  // namespace abut::test_life_signs
