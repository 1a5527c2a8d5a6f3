#pragma once

#include <vector>

namespace abut {

/// How a body divides a window: whole substeps, and a shorter last one where they do not fill it.
/// The rule is part of the contract, because both sides of an interface must know each other's
/// substeps.
struct Substeps {
  double begin = 0.0, end = 0.0, step = 0.0, last = 0.0;  // [s]
  int count = 0;

  /// `step` 0: any window is one substep. Throws RunError for more than most_substeps.
  static Substeps divide(double begin, double end, double step);
  double length(int i) const { return i == count ? last : step; }           // i = 1..count
  double time(int i) const { return i == count ? end : begin + i * step; }  // i = 0..count
  bool matches(const std::vector<double>& times) const;  // the same instants, i = 0..count
  bool same_as(const Substeps& other) const { return count == other.count && step == other.step; }
};

}  // namespace abut
