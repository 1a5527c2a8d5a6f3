#include "coordinator/record/force_ripple.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace abut {

void ForceRipple::add(double from, double to, double before, double now) {
  if (to <= std::max(from, after_)) return;
  if (from < after_) {
    before += (now - before) * (after_ - from) / (to - from);
    from = after_;
  }
  if (time_ == 0.0) first_ = before;
  const double a = before - first_, b = now - first_, length = to - from;
  time_ += length;
  sum_ += 0.5 * (a + b) * length;
  square_ += (a * a + a * b + b * b) / 3.0 * length;
}

double ForceRipple::value() const {
  const double away = time_ > 0.0 ? sum_ / time_ : 0.0, mean = first_ + away;
  if (mean == 0.0) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(std::max(0.0, square_ / time_ - away * away)) / std::abs(mean);
}

void ForceRipple::state(Archive& archive) {
  archive.field("first", first_);
  archive.field("time", time_);
  archive.field("sum", sum_);
  archive.field("square", square_);
}

}  // namespace abut
