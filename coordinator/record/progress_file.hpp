#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "coordinator/record/body_meter.hpp"
#include "coordinator/record/observer.hpp"
#include "coordinator/record/remaining_time.hpp"

namespace abut {

/// progress.json: how far a run is, for `abut monitor`. Written whole at the start and then between
/// two windows, once a second at most; gone when the run has told its end in summary.json. What a
/// killed run leaves says when it was last seen, and which process it was. A file that cannot be
/// written costs a warning, not the run.
class ProgressFile : public Observer {
 public:
  struct Process {                    // of bodies, started by this program
    std::int64_t id = 0;              // of the process
    std::vector<std::size_t> bodies;  // that live in it
  };
  struct Heading {
    std::string title;
    std::map<std::string, std::string> units;  // the scene's word for each unit of SI; empty: SI
    bool local = false;                        // all bodies are in this process
    std::vector<Process> processes;
    bool more = false;  // another stage follows, and tells on
  };
  /// Clock and meter must outlive it.
  ProgressFile(const std::filesystem::path& directory, Heading heading, const BodyMeter& meter,
               const Clock& clock);

  void on_start(const RunStart& start) override;
  void on_window(const WindowReport& report) override;
  void on_end(const RunEnd& end) override;

 private:
  std::string facts(const RunStart& start) const;
  std::string text(double reached, double wall) const;
  double part_of(double time) const { return (time - begin_) / (end_ - begin_); }
  double wall() const;
  void write(double reached);

  std::filesystem::path path_;
  Heading heading_;
  const BodyMeter& meter_;
  const Clock& clock_;
  std::string boot_, space_;        // of this machine since it was started, and of its process ids
  std::vector<std::string> since_;  // of this process, then of the others: when it began
  double opened_ = 0.0;             // [s] since 1970
  double begin_ = 0.0, end_ = 0.0;  // [s] of the run
  std::vector<std::string> bodies_;  // names
  std::string facts_;                // in JSON: what does not change
  std::int64_t windows_ = 0, closed_ = 0;
  int iterations_ = 0;
  Clock::Time began_{}, next_{};
  RemainingTime remaining_;
  bool first_ = true, warned_ = false;
};

}  // namespace abut
