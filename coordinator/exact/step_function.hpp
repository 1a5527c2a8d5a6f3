#pragma once

#include <vector>

namespace abut {

/// A piecewise constant function of time, with its integral. At a jump the value is the one that
/// holds afterwards; before the origin it is the first one.
class StepFunction {
 public:
  StepFunction(double origin, double first) : steps_{{origin, first, 0.0}} {}

  /// Takes a new value from `time` on, at or after the last jump.
  void jump(double time, double value);
  double last() const { return steps_.back().value; }
  double at(double time) const;
  double integral(double time) const;  // from the origin
  /// Appends the times of the jumps strictly between `from` and `to`.
  void jumps_between(double from, double to, std::vector<double>& times) const;

 private:
  struct Step {
    double time, value, integral;  // from `time` on; integral up to it
  };
  std::vector<Step>::const_iterator after(double time) const;  // first jump after `time`
  const Step& step(double time) const;

  std::vector<Step> steps_;  // ascending in time, never empty
};

}  // namespace abut
