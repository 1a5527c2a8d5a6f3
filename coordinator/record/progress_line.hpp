#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/clock.hpp"
#include "coordinator/record/observer.hpp"
#include "coordinator/record/remaining_time.hpp"

namespace abut {

/// Tells people how a run is going: how far it is, what is left, how many contacts are closed, who
/// takes the time. On a terminal one line that is written over, ten times a second; elsewhere log
/// lines, after ten seconds and then ever more rarely. Events are log lines everywhere.
class ProgressLine : public Observer {
 public:
  /// `waited` [s] by body: wall time so far for which each was waited for; must outlive this.
  /// `second`: the scene's unit of time.
  ProgressLine(const Clock& clock, bool terminal, const std::vector<double>& waited,
               std::string second = "s")
      : clock_(clock), terminal_(terminal), waited_(waited), second_(std::move(second)) {}
  ~ProgressLine() override { erase(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  std::string_view kept_as() const override { return "progress"; }
  void state(Archive& archive) override { archive.field("closed", closed_); }
  void on_start(const RunStart& start) override;
  void on_window(const WindowReport& report) override;
  void on_event(const RunEvent& event) override;
  void on_end(const RunEnd& end) override;

 private:
  std::string text(const WindowReport& report, double wall) const;
  double part_of(double time) const { return (time - begin_) / (end_ - begin_); }
  void erase();

  const Clock& clock_;
  bool terminal_;
  const std::vector<double>& waited_;
  std::string second_;
  bool shown_ = false;
  Clock::Time began_{}, next_{};
  double begin_ = 0.0, end_ = 0.0;   // [s] of the run
  std::vector<std::string> bodies_;  // names
  RemainingTime remaining_;
  bool first_ = true;        // no window has ended yet
  std::int64_t closed_ = 0;  // contacts, as events tell them
};

}  // namespace abut
