#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/clock.hpp"
#include "coordinator/estimate.hpp"
#include "coordinator/exact/closed_form.hpp"
#include "coordinator/record/measure_recorder.hpp"
#include "coordinator/record/observer.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// summary.json: the run in one object, written whole at the end. A number that is not finite
/// becomes null with a note; one in the bodies' energies or momenta makes the status "failed".
class Summary : public Observer {
 public:
  /// What is known of a run besides what it does.
  struct Heading {
    std::string title;
    std::map<std::string, std::string> versions;  // of abut and of what it is built with
    std::vector<Expectation> expectations;
    std::optional<Clock::Time> program_began = std::nullopt;  // for timing.startup_s
    std::optional<Estimate> estimate = std::nullopt;          // told before the run
    std::map<std::string, std::string> units = {};  // by SI's, of a scene in others; empty: SI
    // [s] by body: wall time for which each was waited for; null: not known
    const std::vector<double>* waited = nullptr;
  };

  /// `form` may be null. The recorder is told of every event before this, and outlives it.
  Summary(std::filesystem::path directory, Heading heading, const MeasureRecorder& recorder,
          const ClosedForm* form);

  std::string_view kept_as() const override { return "swaps"; }
  void state(Archive& archive) override;
  void on_start(const RunStart& start) override;
  void on_swap(const Swap& swap) override { swaps_.push_back(swap); }
  void on_end(const RunEnd& end) override;

  /// The status that was written: RunEnd's, or "failed".
  const std::string& status() const { return status_; }

 private:
  std::string text(const RunEnd& end) const;

  std::filesystem::path directory_;
  Heading heading_;
  const MeasureRecorder& recorder_;
  const ClosedForm* form_;
  RunStart start_;
  std::vector<Swap> swaps_;
  double startup_seconds_ = 0.0;  // from the program's begin to the first window
  std::string status_;
};

}  // namespace abut
