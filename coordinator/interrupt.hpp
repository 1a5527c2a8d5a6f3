#pragma once

#include <atomic>

namespace abut {

/// What signals ask of this program.
struct Interrupts {
  const std::atomic<bool>& asked;    // to end, in order
  const std::atomic<bool>& at_once;  // and whatever is waited for is not waited for any longer
};

/// From now on Ctrl-C, SIGTERM, SIGHUP (the terminal has closed) and SIGPIPE (nobody reads the
/// output any more) set flags and nothing else, so that the run can end its bodies and files in
/// order. The first sets `asked`; `at_once` comes with the second, or when the patience is over,
/// and is no patience before grant_patience. The third ends the program, but for SIGPIPE. Signals
/// that are ignored already stay so.
Interrupts watch_for_interrupts();

/// Whoever is asked to end has so long, to come to a state that can be kept; `told`: the first
/// signal says that it is waited for.
void grant_patience(unsigned seconds, bool told = false);

/// 130 after Ctrl-C, 143 after SIGTERM and so on, as shells expect; 0 before any.
int interrupt_exit_code();

}  // namespace abut
