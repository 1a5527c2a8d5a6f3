// Goal: bytes that one thread writes into a ring reach another one in their order, and who sleeps
// is woken. Both use one mapping of the memory, so that the thread sanitizer sees what they share;
// the ends of a SharedLink have one each. Oracle: byte k of the stream is a function of k.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <random>
#include <span>
#include <thread>
#include <vector>

#include "messaging/doorbell.hpp"
#include "messaging/ring.hpp"

namespace abut {
namespace {

constexpr std::size_t stream_bytes = 200'000;
// Far above what a wake takes on a loaded machine; one that is lost would cost it.
constexpr std::chrono::seconds long_sleep{20};

std::byte byte_of_stream(std::size_t k) { return static_cast<std::byte>((k * 2654435761u) >> 13); }

/// Memory that both threads see.
struct SharedRing {
  explicit SharedRing(std::size_t bytes) : ring(bytes) {}
  RingCounts counts;
  std::vector<std::byte> ring;
  Doorbell of_reader, of_writer;
};

/// Writes the stream in pieces of any length, and sleeps where there is no room.
void write_stream(SharedRing& shared, std::uint32_t seed) {
  std::mt19937 random(seed);
  RingWriter writer(shared.counts, shared.ring);
  std::vector<std::byte> stream(stream_bytes);
  for (std::size_t k = 0; k < stream.size(); ++k) stream[k] = byte_of_stream(k);
  Bytes rest(stream);
  while (!rest.empty()) {
    writer.put(rest, 1 + random() % 100);
    writer.show();
    shared.of_reader.ring();
    if (writer.room() > 0) continue;
    shared.of_writer.lie_down(Sleeper::for_frames_or_room);
    if (writer.room() == 0) shared.of_writer.sleep(long_sleep);
    shared.of_writer.get_up();
  }
}

/// Bytes that are not those of the stream; ends with the stream.
std::size_t read_stream(SharedRing& shared, std::uint32_t seed) {
  std::mt19937 random(seed);
  RingReader reader(shared.counts, shared.ring);
  std::vector<std::byte> piece(150);
  std::size_t got = 0, wrong = 0;
  while (got < stream_bytes) {
    const std::size_t count = reader.get(std::span(piece).first(1 + random() % piece.size()));
    for (std::size_t k = 0; k < count; ++k) wrong += piece[k] == byte_of_stream(got + k) ? 0 : 1;
    got += count;
    if (count > 0) {
      shared.of_writer.ring_for_room();
      continue;
    }
    shared.of_reader.lie_down(Sleeper::for_frames);
    if (reader.there() == 0) shared.of_reader.sleep(long_sleep);
    shared.of_reader.get_up();
  }
  return wrong + (reader.sound() ? 0 : 1);
}

TEST(Ring, WhatOneThreadWritesAnotherReadsInItsOrder) {
  for (const std::size_t bytes : {64u, 100u, 4096u}) {
    SharedRing shared(bytes);
    const auto begin = std::chrono::steady_clock::now();
    std::thread other([&shared] { write_stream(shared, 1); });
    EXPECT_EQ(read_stream(shared, 2), 0u);
    other.join();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, long_sleep) << "a wake is lost";
  }
}

TEST(Doorbell, WhoLiesDownAndIsRungForDoesNotSleep) {
  Doorbell bell;
  bell.lie_down(Sleeper::for_frames);
  std::thread other([&bell] { bell.ring(); });
  other.join();
  const auto begin = std::chrono::steady_clock::now();
  bell.sleep(long_sleep);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, long_sleep);
}

TEST(Doorbell, WhoSleepsForFramesIsNotWokenForRoom) {
  Doorbell bell;
  bell.lie_down(Sleeper::for_frames);
  bell.ring_for_room();
  const auto begin = std::chrono::steady_clock::now();
  bell.sleep(std::chrono::milliseconds(30));
  // A signal may end a sleep early; none is sent here.
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(30));
}

}  // namespace
}  // namespace abut
