#pragma once

#include <string>
#include <string_view>

namespace abut {

/// A regular expression of the units that stand for this one of SI: "mm" for "m". Of powers,
/// products and ratios it knows the words alone, not what they are of.
std::string unit_pattern(std::string_view si_unit);

}  // namespace abut
