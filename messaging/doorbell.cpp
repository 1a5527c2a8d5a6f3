#include "messaging/doorbell.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <ctime>

namespace abut {

void Doorbell::lie_down(Sleeper what) {
  sleeper_.store(static_cast<std::uint32_t>(what), std::memory_order_relaxed);
  std::atomic_thread_fence(std::memory_order_seq_cst);
}

void Doorbell::sleep(std::chrono::nanoseconds time) {
  const std::uint32_t lying = sleeper_.load(std::memory_order_relaxed);
  if (lying == static_cast<std::uint32_t>(Sleeper::nobody)) return;  // somebody has rung
  constexpr std::int64_t second = 1'000'000'000;
  timespec left{};
  left.tv_sec = static_cast<time_t>(time.count() / second);
  left.tv_nsec = static_cast<long>(time.count() % second);
  syscall(SYS_futex, &sleeper_, FUTEX_WAIT, lying, &left, nullptr, 0);
}

void Doorbell::get_up() {
  sleeper_.store(static_cast<std::uint32_t>(Sleeper::nobody), std::memory_order_relaxed);
}

void Doorbell::ring() {
  std::atomic_thread_fence(std::memory_order_seq_cst);
  if (sleeper_.load(std::memory_order_relaxed) != static_cast<std::uint32_t>(Sleeper::nobody))
    wake();
}

void Doorbell::ring_for_room() {
  std::atomic_thread_fence(std::memory_order_seq_cst);
  if (sleeper_.load(std::memory_order_relaxed) ==
      static_cast<std::uint32_t>(Sleeper::for_frames_or_room))
    wake();
}

void Doorbell::wake() {
  get_up();
  syscall(SYS_futex, &sleeper_, FUTEX_WAKE, 1, nullptr, nullptr, 0);
}

void spare_the_core() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

}  // namespace abut
