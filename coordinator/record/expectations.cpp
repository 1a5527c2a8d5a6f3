#include "coordinator/record/expectations.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

namespace abut {
namespace {

std::string words(const Expectation& expectation) {
  if (expectation.at_most) return fmt::format("at most {}", *expectation.at_most);
  if (expectation.at_least) return fmt::format("at least {}", *expectation.at_least);
  const double equals = expectation.equals.value_or(0.0);
  if (expectation.relative)
    return fmt::format("{} +- {:g} %", equals, 100.0 * *expectation.relative);
  return fmt::format("{} +- {:g}", equals, expectation.absolute.value_or(0.0));
}

// Written so that a value that is not a number fails.
bool met(const Expectation& expectation, double got) {
  if (expectation.at_most) return got <= *expectation.at_most;
  if (expectation.at_least) return got >= *expectation.at_least;
  if (!expectation.equals) return false;
  const double equals = *expectation.equals;
  const double tolerance = expectation.relative ? *expectation.relative * std::abs(equals)
                                                : expectation.absolute.value_or(0.0);
  return std::abs(got - equals) <= tolerance;
}

}  // namespace

std::vector<ExpectationResult> evaluate(const std::vector<Expectation>& expectations,
                                        const Measures& measures) {
  std::vector<ExpectationResult> results;
  for (const Expectation& expectation : expectations) {
    require_measure(expectation.measure, measures.scope);
    ExpectationResult result;
    result.measure = expectation.measure;
    result.expected = words(expectation);
    result.because = expectation.because;
    const auto value = measures.values.find(expectation.measure);
    result.got = value != measures.values.end() ? value->second : std::nan("");
    const auto note = measures.notes.find(expectation.measure);
    if (note != measures.notes.end()) result.note = note->second;
    result.pass = met(expectation, result.got);
    results.push_back(std::move(result));
  }
  return results;
}

std::string to_table(const std::vector<ExpectationResult>& results) {
  std::size_t measure = 7, expected = 8;  // lengths of the headings
  for (const ExpectationResult& result : results) {
    measure = std::max(measure, result.measure.size());
    expected = std::max(expected, result.expected.size());
  }
  fmt::memory_buffer out;
  const auto at = std::back_inserter(out);
  fmt::format_to(at, "{:<{}}  {:<{}}  {:<12}\n", "measure", measure, "expected", expected, "got");
  for (const ExpectationResult& result : results) {
    const std::string got = std::isnan(result.got) ? "no value" : fmt::format("{:.6g}", result.got);
    fmt::format_to(at, "{:<{}}  {:<{}}  {:<12}  {}\n", result.measure, measure, result.expected,
                   expected, got, result.pass ? "ok" : "FAILED");
    if (result.pass) continue;
    if (!result.note.empty()) fmt::format_to(at, "    {}\n", result.note);
    if (!result.because.empty()) fmt::format_to(at, "    expected because: {}\n", result.because);
  }
  return fmt::to_string(out);
}

}  // namespace abut
