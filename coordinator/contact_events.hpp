#pragma once

#include <optional>
#include <vector>

#include "base/archive.hpp"
#include "contract/time_window.hpp"
#include "coordinator/coupling/roles.hpp"
#include "coordinator/coupling/watch.hpp"
#include "coordinator/narrator.hpp"

namespace abut {

/// What contact makes of a run of windows: it closes and opens joints, and says where a window must
/// end because of that. What each joint watches for is its Watch's affair. Reads the latest
/// responses.
class ContactEvents {
 public:
  /// `tolerance`: of the iteration; `window` [s]: a whole one. All references must outlive it.
  ContactEvents(std::vector<Joint>& joints, Bodies& bodies, Roles& roles, Narrator& narrator,
                double tolerance, double window)
      : joints_(joints),
        bodies_(bodies),
        roles_(roles),
        narrator_(narrator),
        window_(window),
        run_{.tolerance = tolerance} {}

  /// Before the first window: settles the roles that are not open, and closes tied joints.
  void start();
  /// The same, at a time [s]: lets sides be iterated that have sprung into each other.
  void engage_sprung(double time);
  /// Before a window: what begins or ends with it.
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
  /// Where surfaces are tied, the longest part of a window from its begin in which every body takes
  /// whole steps of its own, or a single one that is shorter: kernels hold for steps of one length.
  TimeWindow even(const TimeWindow& window) const;
  /// Kick layers that end their contact at the window's begin part with what they were owed.
  bool release_kicks(const TimeWindow& window);
  /// An earlier end: fewer substeps at once, fewer kinks in the map that is iterated.
  std::optional<double> earlier_end(const TimeWindow& window) const;

  /// [J] that contact would pay the bodies for a window that was tried. `energy` [J]: as before.
  double payments(double energy);
  /// [J] that the bodies would keep of what contact has given them, and by which of these joules
  /// they give back by themselves the accounts are lowered.
  double overpaid(double energy);
  void repaid(double energy, double joules);

  /// What contact did in a window that was accepted: its account, the impulse that pays it, and
  /// what observers hear of it.
  void settle(const TimeWindow& window, double energy);
  /// The same of a window that was gone passively.
  void settle_passively(const TimeWindow& window, double energy);

  void state(Archive& archive) { run_.state(archive); }

 private:
  void open(Joint& joint);
  void engage(Joint& joint, const Engagement& how, double time);
  void narrate(const Joint& joint);
  double negligible() const { return run_.still() * bodies_.shortest_step(); }

  std::vector<Joint>& joints_;  // which grow, where everything may touch everything
  Bodies& bodies_;
  Roles& roles_;
  Narrator& narrator_;
  double window_;
  ContactRun run_;
  ContactChanges changes_;  // of one joint
};

}  // namespace abut
