#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "coordinator/coupling/joint.hpp"
#include "coordinator/record/observer.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// The event that a stage waits for (TimeSpec::until): a contact of the scene begins, or has ended.
class StageEvent {
 public:
  /// Precondition: scene.time.until, and the scene has the contact.
  explicit StageEvent(const Scene& scene);

  bool awaits_contact() const { return awaits_contact_; }
  std::string words() const;  // for people

  /// Whether contact that is awaited begins with a window, or may begin in it between sides that
  /// meet in passive forms: all do in a window that goes passively. All stand at its begin.
  bool comes(std::span<const Joint> joints, const TimeWindow& window, const Bodies& bodies,
             bool passively) const;
  /// Whether contact that is awaited has begun in a window that was tried.
  bool came(std::span<const Joint> joints, const Bodies& bodies) const;
  /// Between windows: keeps the latest replies, as long as they are of what was accepted.
  void remember(const Bodies& bodies);
  /// Makes these the latest replies again, where an attempt was taken back since. False: there are
  /// none.
  bool recall(Bodies& bodies) const;
  /// It has come.
  void stop() { stopped_ = true; }
  bool stopped() const { return stopped_; }
  /// Notes what presses after a window that was accepted: by interface.
  void see(std::span<const InterfaceReport> reports);
  /// Whether contact whose end is awaited has ended, and begins not again in the next window.
  /// Between windows.
  bool is_over(std::span<const Joint> joints, const TimeWindow& next, const Bodies& bodies) const;

  void state(Archive& archive) {
    archive.field("pressed", pressed_);
    archive.field("presses", presses_);
  }

 private:
  bool awaits_contact_ = true;
  std::string name_;
  int interface_ = 0;     // of the scene's; behind them: everything
  bool pressed_ = false;  // since the stage began
  bool presses_ = false;  // in the last window
  bool stopped_ = false;
  std::vector<Response> before_;  // by body
};

}  // namespace abut
