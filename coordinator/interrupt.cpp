#include "coordinator/interrupt.hpp"

#include <unistd.h>

#include <csignal>
#include <string_view>

namespace abut {
namespace {

std::atomic<bool> asked{false}, at_once{false};
std::atomic<int> caught{0};
std::atomic<unsigned> patience{0};  // [s]
std::atomic<bool> tells{false};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free &&
                  std::atomic<unsigned>::is_always_lock_free,
              "a signal handler may touch these only when no lock is involved");

/// With what a signal handler may use.
void tell_of_patience() {
  constexpr std::string_view text =
      "\nThe window under way is waited for, to keep a state to go on from; once more: ends now.\n";
  if (write(STDERR_FILENO, text.data(), text.size()) < 0) return;  // nobody reads it
}

void on_signal(int signal) {
  if (signal == SIGALRM) return at_once.store(true);
  int none = 0;
  caught.compare_exchange_strong(none, signal);
  const bool again = asked.exchange(true);
  const unsigned seconds = patience.load();
  if (again || seconds == 0) {
    at_once.store(true);
    if (signal != SIGPIPE) std::signal(signal, SIG_DFL);
  } else {
    alarm(seconds);
    if (tells.load() && signal != SIGPIPE) tell_of_patience();
  }
}

/// What somebody chose to ignore, as nohup does, stays ignored.
void watch(int signal) {
  struct sigaction action {
  }, present{};
  if (sigaction(signal, nullptr, &present) == 0 && present.sa_handler == SIG_IGN) return;
  action.sa_handler = on_signal;
  sigaction(signal, &action, nullptr);
}

}  // namespace

Interrupts watch_for_interrupts() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGALRM}) watch(signal);
  // Whoever reads our output is gone; the next lines for them must not end the program either.
  watch(SIGPIPE);
  return {asked, at_once};
}

void grant_patience(unsigned seconds, bool told) {
  tells.store(told);
  patience.store(seconds);
}

int interrupt_exit_code() {
  const int signal = caught.load();
  return signal == 0 ? 0 : 128 + signal;
}

}  // namespace abut
