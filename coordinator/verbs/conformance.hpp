#pragma once

#include "coordinator/command_line.hpp"

namespace abut {

/// Holds the bodies of a scene, or a program or endpoint alone, to the clauses of the contract and
/// tells each: 0 when all are kept, 1 when one is broken. Throws InputError, RunError.
int conformance_verb(const ConformanceCommand& command);

}  // namespace abut
