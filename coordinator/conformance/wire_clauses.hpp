#pragma once

#include <string>
#include <vector>

#include "coordinator/conformance/clauses.hpp"
#include "coordinator/conformance/wire_trial.hpp"

namespace abut {

std::vector<std::string> names_of_wire_clauses();

/// Holds the program of a body to what the protocol asks of a solver, each clause that is wanted
/// with a process of its own. `pushed`: how the body is advanced where that is asked.
void hold_wire(const WireTrial::Solver& solver, const WireTrial::Pushed& pushed,
               const Wanted& wanted, std::vector<Verdict>& verdicts);

}  // namespace abut
