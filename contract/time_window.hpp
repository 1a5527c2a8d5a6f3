#pragma once

#include <cstdint>

namespace abut {

/// The interval over which bodies are advanced and coupled once (glossary: controller step,
/// window).
struct TimeWindow {
  std::int64_t index = 0;  // counted from 0 over the whole run
  double begin = 0.0;      // [s]
  double end = 0.0;        // [s]

  double length() const { return end - begin; }
};

}  // namespace abut
