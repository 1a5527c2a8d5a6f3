#include "coordinator/window_clock.hpp"

#include <algorithm>
#include <cmath>

namespace abut {

TimeWindow WindowClock::flight(int windows) const {
  const double end = anchor_ + static_cast<double>(since_ + windows) * window_;
  const double last = end > end_ - tolerance * window_ ? end_ : end;
  return {windows_, time_, last, windows, since_, anchor_, window_};
}

double WindowClock::whole_windows(double time) const {
  return std::floor(std::min(time, end_ - time_) / window_ + tolerance);
}

bool WindowClock::is_whole(const TimeWindow& window) const {
  return std::abs(window.length() - window_) < tolerance * window_;
}

void WindowClock::accept(const TimeWindow& window) {
  time_ = window.end;
  ++windows_;
  if (is_whole(window)) {
    ++since_;
  } else {
    anchor_ = window.end;
    since_ = 0;
  }
}

void WindowClock::accept_flight(const TimeWindow& flight, int windows) {
  time_ = flight.end;
  windows_ += windows;
  since_ += windows;
}

void WindowClock::state(Archive& archive) {
  archive.field("anchor", anchor_);
  archive.field("since", since_);
  archive.field("windows", windows_);
  archive.field("time", time_);
}

}  // namespace abut
