#pragma once

#include <span>
#include <vector>

#include "contract/time_window.hpp"

namespace abut {

/// Which points slid at the ends of a window's substeps, over its sweeps. Whether a point slides
/// may hang on what a sweep leaves open, and its coefficient in the next substep hangs on that: it
/// would go to and fro for ever. So from the fourth sweep on a point that slid in one since the
/// third counts as sliding: such points become more and never fewer, which ends.
class SlidPoints {
 public:
  /// A sweep over a window begins.
  void begin(const TimeWindow& window, int substeps, std::size_t points);
  /// `slid` (points), 1: it slid in the substep i of this sweep. Those of earlier sweeps are added,
  /// but not at the window's end: what is handed on is what happened.
  void see(int i, std::span<double> slid);

 private:
  TimeWindow window_;
  int substeps_ = 0, sweep_ = 0;
  std::size_t points_ = 0;
  std::vector<char> slid_;  // (substeps, points) in any sweep that counts
};

}  // namespace abut
