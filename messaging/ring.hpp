#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "messaging/channel.hpp"

namespace abut {

/// How far both sides of a ring are, in bytes since it was made; lies in shared memory. Each side
/// writes one count, reads the other, and keeps its own where nobody else can change it.
struct RingCounts {
  alignas(64) std::atomic<std::uint64_t> written = 0;
  alignas(64) std::atomic<std::uint64_t> read = 0;
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

/// The side of a ring of bytes that writes; the other side may be another process, and may lie.
class RingWriter {
 public:
  RingWriter(RingCounts& counts, std::span<std::byte> ring) : counts_(counts), ring_(ring) {}
  /// [B] that fit now; 0 where the other side is not sound.
  std::size_t room();
  /// Copies as much as fits, at most `most`, takes it off `rest`; the other side sees it when it is
  /// shown.
  void put(Bytes& rest, std::size_t most);
  void show() { counts_.written.store(written_, std::memory_order_release); }
  /// False for good once the other side has claimed to have read what was not written.
  bool sound() const { return sound_; }

 private:
  RingCounts& counts_;
  std::span<std::byte> ring_;
  std::uint64_t written_ = 0;
  bool sound_ = true;
};

/// The side that reads.
class RingReader {
 public:
  RingReader(RingCounts& counts, std::span<const std::byte> ring) : counts_(counts), ring_(ring) {}
  /// [B] that are there; 0 where the other side is not sound.
  std::size_t there();
  /// Copies as much as is there, and gives its room back; how much it was.
  std::size_t get(std::span<std::byte> to);
  /// False for good once the other side has claimed to have written more than the ring holds.
  bool sound() const { return sound_; }

 private:
  RingCounts& counts_;
  std::span<const std::byte> ring_;
  std::uint64_t read_ = 0;
  bool sound_ = true;
};

}  // namespace abut
