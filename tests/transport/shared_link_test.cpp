// Goal: frames pass through shared memory whole and in order, whatever their lengths; an end that
// is wrong in any way is told of and harms nobody. Oracle: the frames that were sent, byte for
// byte; the words of the faults; bytes drawn by a seed.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "messaging/shared_link.hpp"

namespace abut::shared_link_test {
namespace {

using Frame = std::vector<std::byte>;
constexpr SharedLink::Bounds usual{3, 1'000'000};
constexpr std::chrono::microseconds spin{20};

/// Both ends in one process, each with a mapping of its own.
struct Ends {
  explicit Ends(std::size_t ring, std::chrono::microseconds its_spin = spin,
                const SharedLink::Bounds& of_solver = usual)
      : coordinator(SharedLink::make(usual, its_spin, ring)),
        solver(SharedLink::take(dup(coordinator->descriptor()), of_solver)) {}
  std::unique_ptr<SharedLink> coordinator, solver;
};

Frame frame_of(std::size_t size, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Frame frame(size);
  for (std::byte& byte : frame) byte = static_cast<std::byte>(random());
  return frame;
}

bool same(Bytes came, const Frame& sent) {
  return std::ranges::equal(came, sent);  // memcmp takes no null pointer, which empty ones have
}

/// Sends and receives in turns, until the frame is there: what does not fit at once follows.
void pass(SharedLink& from, SharedLink& to, std::uint32_t body, const Frame& frame) {
  ASSERT_TRUE(from.send(body, frame, nullptr));
  FrameBuffer nothing, came;
  std::optional<std::uint32_t> whose;
  for (std::size_t turn = 0; !whose && turn <= frame.size(); ++turn) {
    EXPECT_FALSE(from.receive(Milliseconds(0), nothing));
    whose = to.receive(Milliseconds(0), came);
  }
  ASSERT_EQ(whose, body);
  EXPECT_TRUE(same(came.bytes(), frame));
}

TEST(SharedLink, FramesOfEveryLengthPassAroundTheEndOfTheRing) {
  for (const std::size_t ring : {33u, 64u, 100u, 4096u}) {
    Ends ends(ring);
    for (std::uint32_t k = 0; k < 60; ++k) {
      // Up to twice the ring: each one begins at another place of it.
      const Frame frame = frame_of((k * 37) % (2 * ring), k);
      pass(*ends.coordinator, *ends.solver, k % 3, frame);
      pass(*ends.solver, *ends.coordinator, k % 3, frame);
    }
  }
}

TEST(SharedLink, SeveralFramesWaitInTheRingInTheirOrder) {
  Ends ends(4096);
  for (std::uint64_t round = 0; round < 50; ++round) {
    std::vector<Frame> sent;
    for (std::uint64_t k = 0; k < 10; ++k) {
      sent.push_back(frame_of(100 + 11 * k, 100 * round + k));
      ASSERT_TRUE(ends.solver->send(static_cast<std::uint32_t>(k % 3), sent.back(), nullptr));
    }
    FrameBuffer came;
    for (std::uint32_t k = 0; k < 10; ++k) {
      ASSERT_EQ(ends.coordinator->receive(Milliseconds(0), came), k % 3);
      EXPECT_TRUE(same(came.bytes(), sent[k]));
    }
    EXPECT_FALSE(ends.coordinator->receive(Milliseconds(0), came));
  }
}

/// An end that sends `count` frames, and expects as many; `got` of them have come.
void talk(SharedLink& link, std::size_t count, std::uint64_t mine, std::uint64_t theirs,
          std::atomic<std::size_t>& got, const std::atomic<std::size_t>& got_there, int& wrong) {
  constexpr std::size_t bytes = 300'000;
  FrameBuffer came, next;
  std::optional<std::uint32_t> early;  // whose frame has come while this end's was still on its way
  for (std::size_t k = 0; k < count; ++k) {
    const std::shared_ptr<const Frame> frame =
        std::make_shared<const Frame>(frame_of(bytes, mine + k));
    wrong += link.send(0, *frame, frame) ? 0 : 1;
    // Far above what a frame takes, also where other programs have the cores.
    const std::optional<std::uint32_t> body =
        early ? early : link.receive(Milliseconds(20'000), came);
    if (std::exchange(early, std::nullopt)) std::swap(came, next);
    wrong += body && same(came.bytes(), frame_of(bytes, theirs + k)) ? 0 : 1;
    got = k + 1;
    if (!body) return;
    // What is not sent yet follows. The other end goes on as soon as it has all of it.
    while (!early && got_there < k + 1) early = link.receive(Milliseconds(1), next);
  }
}

TEST(SharedLink, BothEndsSendFramesLongerThanTheRingAtTheSameTime) {
  for (const std::chrono::microseconds its_spin : {spin, std::chrono::microseconds(0)}) {
    Ends ends(8192, its_spin);
    int wrong_here = 0, wrong_there = 0;
    std::atomic<std::size_t> got_here = 0, got_there = 0;
    std::thread other(
        [&] { talk(*ends.solver, 20, 1000, 2000, got_there, got_here, wrong_there); });
    talk(*ends.coordinator, 20, 2000, 1000, got_here, got_there, wrong_here);
    other.join();
    EXPECT_EQ(wrong_here, 0);
    EXPECT_EQ(wrong_there, 0);
  }
}

TEST(SharedLink, WhoSleepsIsWokenByAFrame) {
  for (const std::chrono::microseconds its_spin : {spin, std::chrono::microseconds(0)}) {
    Ends ends(4096, its_spin);
    const TimePoint begin = std::chrono::steady_clock::now();
    std::thread other([&] {
      for (std::uint64_t k = 0; k < 20; ++k) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        ends.solver->send(1, frame_of(50, k), nullptr);
      }
    });
    FrameBuffer came;
    for (int k = 0; k < 20; ++k) EXPECT_TRUE(ends.coordinator->receive(Milliseconds(5'000), came));
    other.join();
    // One wake that is lost costs five seconds.
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(4));
  }
}

TEST(SharedLink, AWaitInVainEndsWhenItsTimeIsOver) {
  Ends ends(4096);
  FrameBuffer came;
  const TimePoint begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(ends.coordinator->receive(Milliseconds(60), came));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(60));
}

TEST(SharedLink, WhileAFrameIsOnItsWayNoOtherIsTaken) {
  Ends ends(64);
  const Frame first = frame_of(500, 1), second = frame_of(10, 2);
  EXPECT_TRUE(ends.coordinator->send(0, first, nullptr));
  EXPECT_FALSE(ends.coordinator->send(1, second, nullptr));
  FrameBuffer nothing, came;
  for (int turn = 0; turn < 100 && !ends.solver->receive(Milliseconds(0), came); ++turn)
    ends.coordinator->receive(Milliseconds(0), nothing);
  EXPECT_TRUE(same(came.bytes(), first));
  pass(*ends.coordinator, *ends.solver, 1, second);
}

TEST(SharedLink, TheSolversEndIsKnownOnceItIsThere) {
  const std::unique_ptr<SharedLink> link = SharedLink::make(usual, spin);
  EXPECT_FALSE(link->joined());
  const std::unique_ptr<SharedLink> other = SharedLink::take(dup(link->descriptor()), usual);
  EXPECT_TRUE(link->joined());
}

TEST(SharedLink, NoOtherDescriptorIsTaken) {
  EXPECT_EQ(SharedLink::take(-1, usual), nullptr);
  EXPECT_EQ(SharedLink::take(open("/dev/null", O_RDWR | O_CLOEXEC), usual), nullptr);
  const int unsealed = memfd_create("test", MFD_CLOEXEC);
  ASSERT_EQ(ftruncate(unsealed, 1 << 20), 0);
  EXPECT_EQ(SharedLink::take(unsealed, usual), nullptr);
  close(unsealed);
}

TEST(SharedLink, NobodyCanChangeItsSize) {
  const std::unique_ptr<SharedLink> link = SharedLink::make(usual, spin);
  EXPECT_NE(ftruncate(link->descriptor(), 0), 0);
  EXPECT_NE(ftruncate(link->descriptor(), 1 << 30), 0);
}

TEST(SharedLink, AFrameFarAboveTheLimitIsToldBeforeItTakesMemory) {
  Ends ends(4096, spin, {3, 1'000'000'000});
  ends.solver->send(0, frame_of(2'000'001, 1), nullptr);
  FrameBuffer came;
  EXPECT_FALSE(ends.coordinator->receive(Milliseconds(1'000), came));
  EXPECT_EQ(ends.coordinator->fault(),
            "sent a frame of 2000001 bytes, far above the limit of 1000000 bytes");
  EXPECT_FALSE(ends.coordinator->send(0, frame_of(10, 1), nullptr));
}

TEST(SharedLink, AFrameOfABodyThatIsNotThereIsAFault) {
  Ends ends(4096, spin, {9, 1'000'000});
  ends.solver->send(3, frame_of(10, 1), nullptr);
  FrameBuffer came;
  EXPECT_FALSE(ends.coordinator->receive(Milliseconds(1'000), came));
  EXPECT_NE(ends.coordinator->fault().find("no frame begins"), std::string::npos);
}

/// What any process that has the memory can do with it.
struct Vandal {
  explicit Vandal(const SharedLink& link, std::size_t ring)
      : size(SharedLink::bytes_for(ring)),
        data(static_cast<std::byte*>(
            mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, link.descriptor(), 0))) {}
  ~Vandal() { munmap(data, size); }
  Vandal(const Vandal&) = delete;
  Vandal& operator=(const Vandal&) = delete;
  std::size_t size;
  std::byte* data;
};

TEST(SharedLink, CountsOfBytesThatAreNotThereAreAFault) {
  Ends ends(4096);
  const Vandal vandal(*ends.coordinator, 4096);
  std::memset(vandal.data, 0xff, 4096);
  FrameBuffer came;
  EXPECT_FALSE(ends.coordinator->receive(Milliseconds(1'000), came));
  EXPECT_NE(ends.coordinator->fault().find("counts bytes that are not there"), std::string::npos);
}

TEST(SharedLink, WhateverStandsInTheMemoryEndsInAFrameAFaultOrAWaitInVain) {
  constexpr std::size_t ring = 256;
  std::mt19937_64 random(7);
  int faults = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    Ends ends(ring, std::chrono::microseconds(0));
    const Vandal vandal(*ends.coordinator, ring);
    FrameBuffer came, nothing;
    for (int act = 0; act < 8; ++act) {
      // Where counts and heads of frames are, more often than elsewhere.
      const std::size_t at = random() % 2 == 0 ? random() % 512 : random() % vandal.size;
      const std::size_t count = std::min<std::size_t>(1 + random() % 12, vandal.size - at);
      for (std::size_t k = 0; k < count; ++k)
        vandal.data[at + k] = static_cast<std::byte>(random() % 3 == 0 ? 0xff : random() % 4);
      ends.solver->send(static_cast<std::uint32_t>(random() % 3), frame_of(random() % 200, 1),
                        nullptr);
      if (ends.coordinator->receive(Milliseconds(0), came)) {
        EXPECT_LE(came.size, usual.largest());
      }
      ends.coordinator->send(0, frame_of(20, 2), nullptr);
      ends.solver->receive(Milliseconds(0), nothing);
    }
    faults += ends.coordinator->fault().empty() ? 0 : 1;
  }
  EXPECT_GT(faults, 200);  // that the trials reach what they are for
}

}  // namespace
}  // namespace abut::shared_link_test
