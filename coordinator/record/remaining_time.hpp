#pragma once

#include <optional>
#include <vector>

namespace abut {

/// What is left of a run: as fast as in the last half of its wall time, for which early windows no
/// longer count.
class RemainingTime {
 public:
  /// `part`: of the scene's time, from 0 to 1, at which it begins; more than 0 where it is resumed.
  void start(double part) { samples_.assign(1, {0.0, part}); }
  /// `wall` [s] since the start, ascending.
  void add(double wall, double part);
  /// [s]; nothing in the first second, and where it does not get on.
  std::optional<double> left(double wall, double part) const;

 private:
  struct Sample {
    double wall = 0.0, part = 0.0;
  };
  std::vector<Sample> samples_{Sample{}};  // ascending
};

}  // namespace abut
