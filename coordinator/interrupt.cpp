#include "coordinator/interrupt.hpp"

#include <csignal>

namespace abut {
namespace {

std::atomic<bool> interrupted{false};
std::atomic<int> caught{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "a signal handler may touch these only when no lock is involved");

void on_signal(int signal) {
  caught.store(signal);
  interrupted.store(true);
}

}  // namespace

const std::atomic<bool>& watch_for_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  // The handler serves once, then the system's own comes back; waits return early.
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  return interrupted;
}

int interrupt_exit_code() {
  const int signal = caught.load();
  return signal == 0 ? 0 : 128 + signal;
}

}  // namespace abut
