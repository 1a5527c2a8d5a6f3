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

/// What somebody chose to ignore, as nohup does, stays ignored.
void watch(int signal, int flags) {
  struct sigaction action {}, present {};
  if (sigaction(signal, nullptr, &present) == 0 && present.sa_handler == SIG_IGN) return;
  action.sa_handler = on_signal;
  action.sa_flags = flags;
  sigaction(signal, &action, nullptr);
}

}  // namespace

const std::atomic<bool>& watch_for_interrupts() {
  // The handler serves once, then the system's own comes back; waits return early.
  watch(SIGINT, static_cast<int>(SA_RESETHAND));
  watch(SIGTERM, static_cast<int>(SA_RESETHAND));
  watch(SIGHUP, static_cast<int>(SA_RESETHAND));
  // Whoever reads our output is gone; the next lines for them must not end the program either.
  watch(SIGPIPE, 0);
  return interrupted;
}

int interrupt_exit_code() {
  const int signal = caught.load();
  return signal == 0 ? 0 : 128 + signal;
}

}  // namespace abut
