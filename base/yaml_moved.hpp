#pragma once

#include <vector>

#include "base/units.hpp"

namespace YAML {
class Node;
}

namespace abut {

/// [0.1, 0.0] as YAML, in digits that read back to the same numbers.
YAML::Node numbers_of(const std::vector<double>& values);

/// A body of a scene once more, without `copies`, with keys of `initial` of its own: position and
/// velocity are added to the body's, anything else is in the place of what the body has, and null
/// leaves a key out. Points and initial fields, those of the copy too, are the body's before it was
/// moved by that position. What is not as it should be stays for the body's reader.
YAML::Node moved_copy(const YAML::Node& body, const YAML::Node& own, const UnitSystem& units);

}  // namespace abut
