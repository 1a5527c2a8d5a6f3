#pragma once

#include "coordinator/command_line.hpp"

namespace abut {

/// Goes on with a run from its latest checkpoint; the exit code. Throws InputError, RunError.
int resume_verb(const ResumeCommand& command);

}  // namespace abut
