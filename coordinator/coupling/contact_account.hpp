#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "base/archive.hpp"
#include "contract/time_window.hpp"
#include "coordinator/coupling/contact.hpp"
#include "coordinator/coupling/joint.hpp"

namespace abut {

/// What all contacts of a run are compared with.
struct ContactRun {
  double tolerance = 0.0;        // of the iteration
  double fastest_touch = 0.0;    // [m/s] of all first touches
  double force_reference = 0.0;  // [N] largest contact force

  /// [m/s] Slower touches are no motion: numerical forerunners begin at 1e-300.
  double still() const { return 1.0e-12 * fastest_touch; }
  void state(Archive& archive);
};

/// A push that begins or ends.
struct ContactChange {
  bool closes = false;
  double time = 0.0;   // [s] where gap (closing) or force (opening) crosses zero, linearly
  double speed = 0.0;  // [m/s] of closing
};
using ContactChanges = std::vector<ContactChange>;

/// The account of contact at one point: what contact gave the bodies and took from them, which
/// impulses pay (docs/METHOD.md, energy of events).
class ContactAccount {
 public:
  /// Where a window that was tried must end [s], so that contact is paid what an event in it has
  /// moved before more happens; the begin of the window: kick layers release there. `energy` [J]:
  /// the largest of the run.
  std::optional<double> event(const Joint& joint, double energy, const ContactRun& run,
                              Bodies& bodies);
  /// Kick layers that end their contact at the window's begin part with what they were owed.
  bool release_kick(Joint& joint, const TimeWindow& window, const ContactRun& run, Bodies& bodies,
                    ContactChanges& changes);
  /// [J] that the bodies would be paid if the window that was tried were accepted.
  double payment(const Joint& joint, double energy, Bodies& bodies);
  /// [J] that the bodies would keep then of what contact has given them.
  double overpaid(const Joint& joint, double energy, Bodies& bodies);
  /// The bodies have given so much [J] of that back by themselves.
  void repaid(double joules) { debt_ += joules; }
  /// What contact did in a window that was accepted, and the impulse that pays it.
  void settle(Joint& joint, const TimeWindow& window, double energy, ContactRun& run,
              Bodies& bodies, ContactChanges& changes);

  /// Of a window that was gone passively: its bodies own what they have, nothing is owed. A push
  /// ends with a window in which nothing pressed and the sides part.
  void settle_passively(Joint& joint, const TimeWindow& window, ContactRun& run,
                        const Bodies& bodies, ContactChanges& changes);

  void state(Archive& archive);

 private:
  double least_force(const Joint& joint, const ContactRun& run) const;
  double due_impulse(const Joint& joint, double debt, double energy, const Bodies& bodies) const;
  void see_pushes(Joint& joint, ContactRun& run, ContactChanges& changes);
  void disengage(Joint& joint, const TimeWindow& window, const ContactRun& run,
                 const Bodies& bodies) const;

  double opened_at_ = -std::numeric_limits<double>::infinity();  // [s] last release of a kick layer
  // Where the push that goes on began [s], and how fast its sides met [m/s].
  double touched_at_ = 0.0, touch_speed_ = 0.0;
  double debt_ = 0.0;             // [J] that contact took from the bodies and owes them  [M.25]
  double rebound_impulse_ = 0.0;  // [N s] that a release now would give back
  ContactHistory history_;
};

}  // namespace abut
