#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/conformance/body_trial.hpp"

namespace abut {

/// A clause of the contract, as a trial of a body from where it stands. Returns why it was not
/// asked, or nothing where the body keeps it; throws BrokenClause, or what the body or the way to
/// it throws. Leaves the body in some later state.
struct Clause {
  const char* name;
  const char* says;  // what a body must do
  std::string (*hold)(BodyTrial& trial);
};

/// What windows must be, whatever acts on the body.
std::span<const Clause> clauses_of_windows();
/// What probes must tell.
std::span<const Clause> clauses_of_kernels();
/// What flights must keep within.
std::span<const Clause> clauses_of_speeds();
/// What forces must do.
std::span<const Clause> clauses_of_forces();
/// What motion must be: velocities, and points that forces act on.
std::span<const Clause> clauses_of_motion();

struct Verdict {
  std::string clause, says;
  bool kept = true;
  std::string words = {};  // why it was not asked, or how it is broken; empty: kept
};

/// What becomes of a clause that is held by `hold`, which returns or throws as Clause::hold does.
Verdict judged(const char* name, const char* says, const std::function<std::string()>& hold);

/// Names of the clauses that are wanted; empty: all.
using Wanted = std::vector<std::string>;
bool wants(const Wanted& wanted, std::string_view clause);

/// Holds a body to those of the clauses that are wanted, in their order. A clause that a body
/// breaks ends no other one, as long as the body is there.
void hold(std::span<const Clause> clauses, const Wanted& wanted, BodyTrial& trial,
          std::vector<Verdict>& verdicts);

}  // namespace abut
