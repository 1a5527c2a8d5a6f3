#pragma once

#include <atomic>

namespace abut {

/// From now on the first Ctrl-C or SIGTERM sets a flag and nothing else, so that the run can end
/// its bodies and files in order; the second ends the program at once.
const std::atomic<bool>& watch_for_interrupts();

/// 130 after Ctrl-C, 143 after SIGTERM, as shells expect; 0 before either.
int interrupt_exit_code();

}  // namespace abut
