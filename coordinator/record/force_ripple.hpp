#pragma once

#include "base/archive.hpp"

namespace abut {

/// How much a force changes while it should not: its standard deviation over the magnitude of its
/// mean, of a series that is linear between its samples, from a time on.
class ForceRipple {
 public:
  explicit ForceRipple(double after) : after_(after) {}  // [s]

  /// A stretch of the series, times [s] and forces [N] at its ends.
  void add(double from, double to, double before, double now);
  /// NaN where nothing was told or the mean is zero.
  double value() const;

  void state(Archive& archive);

 private:
  double after_;
  double first_ = 0.0;  // [N] sums are of differences from it: they would round a small ripple
  double time_ = 0.0, sum_ = 0.0, square_ = 0.0;  // [s], [N s], [N^2 s]
};

}  // namespace abut
