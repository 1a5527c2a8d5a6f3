#pragma once

#include "coordinator/command_line.hpp"

namespace abut {

/// `abut run`. Returns the exit code: 1 when an expectation or the run failed. Throws InputError,
/// RunError.
int run_verb(const RunCommand& command);

}  // namespace abut
