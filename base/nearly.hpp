#pragma once

#include <algorithm>
#include <cmath>

namespace abut {

/// Equal but for roundings, which turns, moves, units and orders of sums change: what differs by
/// less than 1e-9 is no reason to choose one side and not the other.
inline bool nearly_equal(double a, double b) {
  constexpr double rounding = 1.0e-9;
  return a == b || std::abs(a - b) <= rounding * std::max(std::abs(a), std::abs(b));
}

}  // namespace abut
