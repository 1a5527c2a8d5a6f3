#include "coordinator/conformance/clauses.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"

namespace abut {

Verdict judged(const char* name, const char* says, const std::function<std::string()>& hold) {
  Verdict verdict{name, says};
  try {
    verdict.words = hold();
    return verdict;
  } catch (const BrokenClause& broken) {
    verdict.words = fmt::format("{}. {}", broken.what_it_does, broken.where_to_look);
  } catch (const InputError& error) {
    verdict.words = error.what();
  } catch (const RunError& error) {
    verdict.words = error.what();
  }
  verdict.kept = false;
  return verdict;
}

bool wants(const Wanted& wanted, std::string_view clause) {
  return wanted.empty() || std::ranges::find(wanted, clause) != wanted.end();
}

void hold(std::span<const Clause> clauses, const Wanted& wanted, BodyTrial& trial,
          std::vector<Verdict>& verdicts) {
  for (const Clause& clause : clauses)
    if (wants(wanted, clause.name))
      verdicts.push_back(judged(clause.name, clause.says, [&] { return clause.hold(trial); }));
}

}  // namespace abut
