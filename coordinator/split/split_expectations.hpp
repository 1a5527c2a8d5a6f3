#pragma once

#include <string>
#include <utility>
#include <vector>

#include "coordinator/scene_meta.hpp"
#include "coordinator/split/split_body.hpp"
#include "coordinator/split/split_names.hpp"

namespace abut {

/// What a divided scene is: whose parts, called what, and what became of the rest.
struct Division {
  const WholeBody& whole;
  const std::vector<std::string>& names;  // of the parts
  const SplitNames& where;
  std::vector<std::string> divided_interfaces;  // that are several now
  bool shorter_windows = false;
};

/// What becomes of what a scene expects when one of its bodies is several.
struct SplitExpectations {
  std::vector<Expectation> kept;                              // of the divided scene
  std::vector<std::pair<std::string, std::string>> left_out;  // measure, and why
};

/// Expectations of one part's own, of the other bodies and of all bodies stay; bounds of what is
/// the largest or smallest of a body hold for every part; what is a sum or a mean over parts, or of
/// how windows are iterated, is left out.
SplitExpectations divide_expectations(const std::vector<Expectation>& expectations,
                                      const Division& division);

}  // namespace abut
