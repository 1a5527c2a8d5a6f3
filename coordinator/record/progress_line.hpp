#pragma once

#include <cstdint>
#include <string>

#include "base/clock.hpp"
#include "coordinator/record/observer.hpp"

namespace abut {

/// Tells people how a run is going: on a terminal one line that is written over, ten times a
/// second; elsewhere a log line per event.
class ProgressLine : public Observer {
 public:
  ProgressLine(const Clock& clock, bool terminal) : clock_(clock), terminal_(terminal) {}
  ~ProgressLine() override { erase(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void on_start(const RunStart& start) override;
  void on_window(const WindowReport& report) override;
  void on_event(const RunEvent& event) override;
  void on_end(const RunEnd& end) override;

 private:
  std::string text(const WindowReport& report) const;
  void erase();

  const Clock& clock_;
  bool terminal_;
  bool shown_ = false;
  Clock::Time next_{};
  double begin_ = 0.0, end_ = 0.0;  // [s] of the run
  std::vector<std::string> names_;  // of the interfaces
  std::int64_t solves_ = 0;         // at least so many exchanges
};

}  // namespace abut
