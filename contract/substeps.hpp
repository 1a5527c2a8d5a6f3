#pragma once

#include <vector>

#include "contract/time_window.hpp"

namespace abut {

/// How a body divides a window: whole substeps, and a shorter last one where they do not fill it.
/// The rule is part of the contract, because both sides of an interface must know each other's
/// substeps.
struct Substeps {
  double begin = 0.0, end = 0.0, step = 0.0, last = 0.0;  // [s]
  int count = 0;
  // Of several windows in a row: how many substeps each has, 0: there is one window; whether these
  // are its equal shares.
  int each = 0;
  bool shares = false;
  TimeWindow row = {};

  /// `step` 0: any window is one substep. Throws RunError for more than most_substeps.
  static Substeps divide(double begin, double end, double step);
  /// Each of several windows in a row as if it were alone. `step` 0: all have so many substeps of
  /// equal length.
  static Substeps divide(const TimeWindow& window, double step, int otherwise);
  double length(int i) const {  // i = 1..count
    if (each > 0) return length_in_row(i);
    return i == count ? last : step;
  }
  double time(int i) const {  // i = 0..count
    if (each > 0) return time_in_row(i);
    return i == count ? end : begin + i * step;
  }
  bool matches(const std::vector<double>& times) const;  // the same instants, i = 0..count
  bool same_as(const Substeps& other) const { return count == other.count && step == other.step; }

 private:
  double length_in_row(int i) const;
  double time_in_row(int i) const;
};

}  // namespace abut
