#include "coordinator/conformance/clauses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

namespace abut {

Verdict judged(const char* name, const char* says, const std::function<std::string()>& hold) {
  Verdict verdict{name, says};
  try {
    verdict.words = hold();
    return verdict;
  } catch (const BrokenClause& broken) {
    verdict.words = fmt::format("{}. {}", broken.what_it_does, broken.where_to_look);
  } catch (const std::exception& error) {  // of the way to it, too
    verdict.words = error.what();
  }
  verdict.kept = false;
  return verdict;
}

namespace {

/// What a clause left undefined, a window that failed, is no state to go on from.
void return_to_saved(BodyTrial& trial) {
  try {
    trial.restore();
  } catch (const std::exception&) {
    return;  // the body is gone: the next clause says so
  }
}

}  // namespace

bool wants(const Wanted& wanted, std::string_view clause) {
  return wanted.empty() || std::ranges::find(wanted, clause) != wanted.end();
}

void hold(std::span<const Clause> clauses, const Wanted& wanted, BodyTrial& trial,
          std::vector<Verdict>& verdicts) {
  for (const Clause& clause : clauses) {
    if (!wants(wanted, clause.name)) continue;
    verdicts.push_back(judged(clause.name, clause.says, [&] {
      trial.save();
      return clause.hold(trial);
    }));
    if (!verdicts.back().kept) return_to_saved(trial);
  }
}

}  // namespace abut
