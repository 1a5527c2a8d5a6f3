#include "coordinator/settled_end.hpp"

#include <cmath>

namespace abut {

namespace {

/// Of a whole window, and in how many: loads grow by half a hundredth of what they do in a whole
/// one, of which springs of a hundredth of a body's stiffness bear a hundredth.
constexpr double left_part = 0.02;
constexpr int short_windows = 4;
constexpr double rounded = 1.0e-6;  // of a short window

}  // namespace

TimeWindow before_settled_end(TimeWindow next, double end) {
  const double piece = left_part / short_windows * next.whole;
  if (next.end < end - rounded * piece) return next;
  const double begin = end - short_windows * piece;
  const double done = std::floor((next.begin - begin) / piece + rounded);
  const int after = done < 0.0 ? 0 : static_cast<int>(done) + 1;
  if (after < short_windows) next.end = begin + after * piece;
  return next;
}

}  // namespace abut
