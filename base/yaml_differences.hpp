#pragma once

#include <string>
#include <vector>

namespace abut {

/// A value that two scenes have not in common.
struct Difference {
  std::string key;          // key path
  std::string before, now;  // as YAML on one line; empty: absent
};

/// Values that two texts in YAML have not in common, in the order of the first; lists and values
/// are compared whole, and a key of one alone with all that is below it. Throws InputError of text
/// that is no YAML.
std::vector<Difference> differences(const std::string& before, const std::string& now);

}  // namespace abut
