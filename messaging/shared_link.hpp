#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "messaging/channel.hpp"
#include "messaging/doorbell.hpp"
#include "messaging/ring.hpp"
#include "messaging/shared_memory.hpp"

namespace abut {

/// A frame that has come; keeps its memory from frame to frame.
struct FrameBuffer {
  std::vector<std::byte> memory;
  std::size_t size = 0;  // [B] of the frame, from the begin
  Bytes bytes() const { return Bytes(memory).first(size); }
  void hold(std::size_t bytes);
};

/// One end of two rings in memory that the coordinator shares with a process that it has started:
/// frames of the bodies of that process, both ways, whole and in order. A frame that is longer than
/// a ring passes through it piece by piece. What comes is copied out of the shared memory before
/// anybody looks at it, and every length and count in there is read once: the other end may be
/// wrong in any way, which `fault` then tells.
class SharedLink {
 public:
  enum class End { coordinator, solver };
  struct Bounds {
    std::uint32_t bodies = 1;     // numbered from 0
    std::size_t frame_bytes = 0;  // a frame may be twice as long; whoever reads it refuses it
    std::size_t largest() const { return 2 * frame_bytes; }
  };
  /// [B] of memory for rings of so many bytes.
  static std::size_t bytes_for(std::size_t ring);
  /// [B] of a ring by default: large enough for the messages of most bodies, small enough for the
  /// caches of a core.
  static constexpr std::size_t usual_ring = std::size_t{256} << 10;

  /// The coordinator's end comes first; `spin`: how long either end may look for a frame before it
  /// sleeps, where the last one has come as soon as that.
  static std::unique_ptr<SharedLink> make(const Bounds& bounds, std::chrono::microseconds spin,
                                          std::size_t ring = usual_ring);
  /// The solver's end; null where this is no memory of a coordinator of this version.
  static std::unique_ptr<SharedLink> take(int descriptor, const Bounds& bounds);
  ~SharedLink();
  SharedLink(const SharedLink&) = delete;
  SharedLink& operator=(const SharedLink&) = delete;

  /// To hand over to the solver's process.
  int descriptor() const { return memory_->descriptor(); }
  void handed_over() { memory_->close_file(); }
  /// Whether the solver's end is there.
  bool joined() const;

  /// The frame is on its way: what does not fit into the ring, while the other end does not read,
  /// follows during later calls. False while an earlier frame is still on its way. `owner`, where
  /// it is not null, keeps the bytes as they are; else what is left is copied.
  bool send(std::uint32_t body, Bytes frame, std::shared_ptr<const void> owner);
  /// The next frame, and of which body it is; nothing when none came within `wait`.
  std::optional<std::uint32_t> receive(Milliseconds wait, FrameBuffer& frame);
  /// What is wrong with the other end, as a predicate; empty: nothing.
  const std::string& fault() const { return fault_; }

 private:
  struct Shared;
  struct FrameHead;
  static constexpr std::size_t head_bytes = 16;

  SharedLink(std::unique_ptr<SharedMemory> memory, End end, const Bounds& bounds);
  bool unsent() const { return !head_rest_.empty() || !frame_rest_.empty(); }
  void push();
  void wait_for_room();
  bool take_frame();
  bool take_head();
  bool stirs();
  bool look(TimePoint until);
  void sleep(Sleeper what, TimePoint until);
  void look_at_counts();

  std::unique_ptr<SharedMemory> memory_;
  Shared& shared_;
  Bounds bounds_;
  std::size_t piece_;  // [B] after which the other end is told
  RingWriter out_;
  RingReader in_;
  Doorbell& mine_;
  Doorbell& theirs_;
  std::chrono::nanoseconds spin_;
  std::chrono::nanoseconds last_wait_{0};  // for a frame
  std::array<std::byte, head_bytes> out_head_{}, in_head_{};
  Bytes head_rest_, frame_rest_;  // of what is on its way out
  std::shared_ptr<const void> owner_;
  std::vector<std::byte> kept_;
  std::size_t head_got_ = 0, frame_got_ = 0;  // of what comes
  std::uint32_t body_ = 0;
  FrameBuffer incoming_;
  std::string fault_;
};

}  // namespace abut
