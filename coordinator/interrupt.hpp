#pragma once

#include <atomic>

namespace abut {

/// From now on the first Ctrl-C, SIGTERM, SIGHUP (the terminal has closed) or SIGPIPE (nobody reads
/// the output any more) sets a flag and nothing else, so that the run can end its bodies and files
/// in order; the second ends the program at once, but for SIGPIPE. Signals that are ignored
/// already stay so.
const std::atomic<bool>& watch_for_interrupts();

/// 130 after Ctrl-C, 143 after SIGTERM and so on, as shells expect; 0 before any.
int interrupt_exit_code();

}  // namespace abut
