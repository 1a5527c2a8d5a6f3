#pragma once

#include <string>
#include <vector>

#include "coordinator/record/measure_names.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// An expectation of the scene after the run.
struct ExpectationResult {
  std::string measure;
  std::string expected;  // for people: "0.0005 +- 0.01 %", "at most 2"
  double got = 0.0;      // NaN: the measure has no value in this run
  bool pass = false;
  std::string because;  // as the scene says
  std::string note;     // why there is no value; else empty
};

/// One result per expectation, in their order. Throws InputError when a measure does not exist; one
/// that exists and has no value in this run fails.
std::vector<ExpectationResult> evaluate(const std::vector<Expectation>& expectations,
                                        const Measures& measures);

/// A table for a terminal: one line per result, the reason below those that fail.
std::string to_table(const std::vector<ExpectationResult>& results);

}  // namespace abut
