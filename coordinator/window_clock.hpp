#pragma once

#include <cstdint>

#include "base/archive.hpp"
#include "contract/time_window.hpp"

namespace abut {

/// The clock of a run: how far it has come, and where the next window ends. Windows are counted
/// from an anchor, which is the begin or the end of the last window that an event has cut: times
/// are never summed up.
class WindowClock {
 public:
  /// Begin, end and length of a whole window [s].
  WindowClock(double begin, double end, double window)
      : end_(end), window_(window), anchor_(begin), time_(begin) {}

  double time() const { return time_; }
  std::int64_t windows() const { return windows_; }  // accepted so far
  bool at_end() const { return time_ >= end_ - tolerance * window_; }
  /// The next window; a remainder too short to be one of its own belongs to the last.
  TimeWindow next() const { return flight(1); }
  /// Several whole windows in one.
  TimeWindow flight(int windows) const;
  /// Whole windows that fit into a time [s] from now on, and before the end.
  double whole_windows(double time) const;
  bool is_whole(const TimeWindow& window) const;

  void accept(const TimeWindow& window);
  /// The run ends here, before its end.
  void stop() { end_ = time_; }
  /// Whole windows of another length than before begin here.
  void anchor() { anchor_ = time_, since_ = 0; }
  void accept_flight(const TimeWindow& flight, int windows);

  void state(Archive& archive);

 private:
  static constexpr double tolerance = 1.0e-9;  // of a window: rounded ends are the same

  double end_, window_;     // [s]
  double anchor_;           // [s]
  std::int64_t since_ = 0;  // whole windows since the anchor
  std::int64_t windows_ = 0;
  double time_;  // [s]
};

}  // namespace abut
