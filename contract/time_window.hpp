#pragma once

#include <cstdint>

namespace abut {

/// The interval over which bodies are advanced and coupled once (glossary: controller step,
/// window), or several of them in a row in which nothing touches.
struct TimeWindow {
  std::int64_t index = 0;  // counted from 0 over the whole run
  double begin = 0.0;      // [s]
  double end = 0.0;        // [s]
  // Several: where each of them ends, so that bodies divide them to the last bit as one by one.
  std::int64_t windows = 1;
  std::int64_t since = 0;  // windows from the anchor to the begin
  double anchor = 0.0;     // [s]
  double whole = 0.0;      // [s] length of each

  double length() const { return end - begin; }
  /// Where the k-th window ends, k = 1..windows; 0: the begin.
  double stop(std::int64_t k) const {
    if (k <= 0) return begin;
    return k >= windows ? end : anchor + static_cast<double>(since + k) * whole;
  }
};

}  // namespace abut
