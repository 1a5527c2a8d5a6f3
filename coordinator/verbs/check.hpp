#pragma once

#include "coordinator/command_line.hpp"

namespace abut {

/// `abut check`: what a scene's run will be, told before it. Returns the exit code; throws
/// InputError.
int check_verb(const CheckCommand& command);

}  // namespace abut
