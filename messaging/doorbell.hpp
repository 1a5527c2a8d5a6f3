#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

namespace abut {

/// What the process behind a doorbell sleeps for.
enum class Sleeper : std::uint32_t { nobody = 0, for_frames = 1, for_frames_or_room = 2 };

/// On which one process sleeps until another rings; lies in shared memory. Who sleeps says so first
/// and looks once more at what it waits for; who rings has changed that before it looks for a
/// sleeper: one of both sees the other.
class Doorbell {
 public:
  void lie_down(Sleeper what);
  /// Until somebody rings, a signal comes or the time is over; after lie_down.
  void sleep(std::chrono::nanoseconds time);
  void get_up();
  /// Frames have come.
  void ring();
  /// There is room for more.
  void ring_for_room();

 private:
  void wake();
  std::atomic<std::uint32_t> sleeper_ = 0;
};
static_assert(std::atomic<std::uint32_t>::is_always_lock_free && sizeof(Doorbell) == 4);

/// Tells the processor that this thread only looks at memory again and again.
void spare_the_core();

}  // namespace abut
