#pragma once

#include <optional>
#include <span>

#include "base/archive.hpp"
#include "contract/time_window.hpp"
#include "coordinator/coupling/contact.hpp"
#include "coordinator/coupling/roles.hpp"
#include "coordinator/narrator.hpp"

namespace abut {

/// What contact makes of a run of windows: it closes and opens joints, says where a window must end
/// because of that, and keeps the account of what contact gave the bodies and took from them
/// (docs/METHOD.md, energy of events). Reads the latest responses.
class ContactEvents {
 public:
  /// `tolerance`: of the iteration; `window` [s]: a whole one. All references must outlive it.
  ContactEvents(std::vector<Joint>& joints, Bodies& bodies, Roles& roles, Narrator& narrator,
                double tolerance, double window)
      : joints_(joints),
        bodies_(bodies),
        roles_(roles),
        narrator_(narrator),
        tolerance_(tolerance),
        window_(window) {}

  /// Before the first window: settles the roles that are not open, and closes tied joints.
  void start();
  /// After it, when velocities of tied surfaces are one: from where these go on.
  void join();
  /// Before a window: the published criteria of joints that decide there.
  void begin(const TimeWindow& window);

  // Of a window that was tried:

  /// Lets sides that were free and met be iterated from now on; the end of the first substep in
  /// which any did [s].
  std::optional<double> engage_touching(const TimeWindow& window);
  /// Where the window must end so that contact is paid what an event in it has moved, before more
  /// happens: at the first common end of substeps. A release of kick layers gives its impulse at
  /// the end of the last kick. `energy` [J]: the largest of the run.
  std::optional<double> first_event(const TimeWindow& window, double energy);
  /// First time in the window, from `time` on, at which substeps of all bodies end.
  double common_end(const TimeWindow& window, double time) const;
  /// Kick layers that end their contact at the window's begin part with what they were owed.
  bool release_kicks(const TimeWindow& window);
  /// An earlier end: fewer substeps at once, fewer kinks in the map that is iterated.
  std::optional<double> earlier_end(const TimeWindow& window) const;

  // Of a window that was accepted:

  /// What contact did in it: its account, the impulse that pays it, and what is told of it.
  void settle(const TimeWindow& window, double energy);
  /// Contact inside a body is computed there: nothing is imposed, it is told what was seen.
  void watch_inside(std::span<InterfaceReport> reports);
  /// The published form exchanges roles after every window in contact.
  void swap_roles();

  void state(Archive& archive);

 private:
  void open(Joint& joint);
  void engage(Joint& joint, double speed, double time);
  void approach(Joint& joint, const TimeWindow& window);
  void settle_surfaces(Joint& joint);
  void pay(Joint& joint, double energy);
  void narrate(Joint& joint);
  void disengage(Joint& joint, const TimeWindow& window) const;
  double least_force(const Joint& joint) const;
  double still() const;

  std::vector<Joint>& joints_;  // which grow, where everything may touch everything
  Bodies& bodies_;
  Roles& roles_;
  Narrator& narrator_;
  double tolerance_, window_;
  double fastest_touch_ = 0.0;    // [m/s] of all first touches
  double force_reference_ = 0.0;  // [N] largest contact force of the run
  ContactHistory history_;
};

}  // namespace abut
