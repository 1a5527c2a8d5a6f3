#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/clock.hpp"
#include "coordinator/controller.hpp"
#include "coordinator/record/checkpoint_file.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// When a run is kept, and all that is kept of it.
class Checkpoints {
 public:
  struct Keeping {
    std::filesystem::path directory;
    std::optional<CheckpointSpec> when;  // absent: where a run is interrupted alone
    bool more = false;                   // a stage follows: the end of this one is kept
    std::string scene;                   // resolved
    std::vector<std::string> swapped;    // bodies of which the next stage has another model
  };
  /// Bodies, observers and the clock must outlive this.
  Checkpoints(Keeping keeping, std::vector<Subdomain*> bodies, std::vector<Observer*> observers,
              const Clock& clock);

  /// Controller::between_windows. Writes a checkpoint where one is due. Throws RunError.
  void look(const Pause& pause, Controller& controller);
  /// A run is to go on from a checkpoint, which must be of these bodies: gives its state to all of
  /// them, before the first window. Throws InputError, RunError.
  void resume(const Checkpoint& from, Controller& controller);

  /// [s] of the scene: the latest; nothing: there is none.
  std::optional<double> latest() const { return latest_; }

 private:
  bool due(const Pause& pause) const;
  void write(const Pause& pause, Controller& controller);

  Keeping keeping_;
  std::vector<Subdomain*> bodies_;
  std::vector<Observer*> observers_;
  const Clock& clock_;
  std::optional<double> latest_;
  double time_ = 0.0;  // of the latest, or of the begin
  std::int64_t windows_ = 0;
  Clock::Time written_;
  bool begun_ = false;
};

}  // namespace abut
