#pragma once

#include <cmath>
#include <concepts>

namespace abut {

/// Substeps that one request may hold: what is numbered by int, with room for doubling.
inline constexpr double most_substeps = 1.0e9;

/// The whole number nearest to a double, held between `low` and `high`; no number gives `low`. A
/// cast of what does not fit into the type would be undefined.
template <std::integral Int>
Int count_within(double value, Int low, Int high) {
  if (!(value > static_cast<double>(low))) return low;
  if (value >= static_cast<double>(high)) return high;
  return static_cast<Int>(std::llround(value));
}

}  // namespace abut
