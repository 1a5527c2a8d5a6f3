#include "coordinator/exact/step_function.hpp"

#include <algorithm>

#include "base/assert.hpp"

namespace abut {

void StepFunction::jump(double time, double value) {
  const Step& newest = steps_.back();
  ABUT_ASSERT(time >= newest.time);
  // The first value holds before the origin even if it jumps there.
  if (time == newest.time && steps_.size() > 1) {
    steps_.back().value = value;
  } else {
    steps_.push_back({time, value, newest.integral + newest.value * (time - newest.time)});
  }
}

std::vector<StepFunction::Step>::const_iterator StepFunction::after(double time) const {
  return std::upper_bound(steps_.begin(), steps_.end(), time,
                          [](double t, const Step& step) { return t < step.time; });
}

const StepFunction::Step& StepFunction::step(double time) const {
  const std::vector<Step>::const_iterator next = after(time);
  return next == steps_.begin() ? steps_.front() : *std::prev(next);
}

double StepFunction::at(double time) const { return step(time).value; }

double StepFunction::integral(double time) const {
  const Step& now = step(time);
  return now.integral + now.value * (time - now.time);
}

void StepFunction::jumps_between(double from, double to, std::vector<double>& times) const {
  for (std::vector<Step>::const_iterator s = after(from); s != steps_.end() && s->time < to; ++s)
    times.push_back(s->time);
}

}  // namespace abut
