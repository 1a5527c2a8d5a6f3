#pragma once

#include <optional>
#include <vector>

#include "base/archive.hpp"
#include "contract/time_window.hpp"
#include "coordinator/coupling/contact_account.hpp"
#include "coordinator/coupling/joint.hpp"

namespace abut {

/// When it is decided whether the sides of a joint press on each other.
enum class Decision {
  every_substep,  // by the kinematic body
  window_begin,   // by the coordinator: the published form
  inside,         // both sides are ports of one body: watched, never iterated
  never,          // tied, from the start to the end
};

/// How near the sides of a joint are when a window or a flight begins.
struct Approach {
  double apart = 0.0;  // [m] from below
  double speed = 0.0;  // [m/s] at which they may close; infinity: unknown
};

/// A joint that was not iterated is to be.
struct Engagement {
  double speed = 0.0;    // [m/s] at which the sides met
  double end = 0.0;      // [s] where the window that is tried must end
  bool presses = false;  // the sides press from the window's begin on
  double impulse = 0.0;  // [N s] with which they begin
};

/// What the sides of a joint show of it in the latest replies.
struct Shown {
  bool closed = false;
  double missed = 0.0;  // [m] by which tied sides miss each other
  double force = 0.0;   // [N] largest resultant between tied sides
};

/// When a joint opens, closes and flies. Reads the latest replies.
class Watch {
 public:
  virtual ~Watch() = default;
  virtual Decision decision() const = 0;

  // Before a window or a flight:

  virtual Approach approach(const Joint& joint, const Bodies& bodies) = 0;
  /// What begins or ends with a window; a joint that is to be iterated from now on.
  virtual std::optional<Engagement> begin(Joint&, const TimeWindow&, const Bodies&,
                                          ContactChanges&) {
    return std::nullopt;
  }

  // Of a window or a flight that was tried:

  /// Whether the sides of a joint that is not iterated stayed apart over `length` [s].
  virtual bool stayed_apart(const Joint& joint, const Bodies& bodies, double length) const = 0;
  /// Sides that were free and met. `negligible` [m]: less is no overlap.
  virtual std::optional<Engagement> touch(const Joint&, const TimeWindow&, const Bodies&,
                                          double /*negligible*/) const {
    return std::nullopt;
  }
  virtual double peak_force(const Joint& joint, const Bodies& bodies) const = 0;  // [N]
  virtual Shown show(const Joint& joint, const Bodies& bodies) const = 0;

  // Of a window or a flight that was accepted:

  /// What contact did in it. `energy` [J]: the largest of the run.
  virtual void settle(Joint& joint, const TimeWindow& window, double energy, ContactRun& run,
                      Bodies& bodies, ContactChanges& changes) = 0;
  /// Notes whether the sides came so near that they may have passed each other.
  virtual void see_passing(const Joint& joint, const Bodies& bodies) = 0;
  /// Whether the sides went past each other and never pressed.
  virtual bool passed(const Joint& joint, const Bodies& bodies) const = 0;

  /// What the watch carries from window to window beside its account.
  virtual void state(Archive& archive) = 0;
  /// The energy that contact took and owes; null: none is kept.
  ContactAccount* account() { return account_ ? &*account_ : nullptr; }

 protected:
  std::optional<ContactAccount> account_;
};

}  // namespace abut
