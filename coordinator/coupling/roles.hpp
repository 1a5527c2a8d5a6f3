#pragma once

#include <optional>
#include <span>
#include <vector>

#include "coordinator/coupling/bodies.hpp"
#include "coordinator/coupling/joint.hpp"

namespace abut {

/// Which bodies come before which in a sweep: kinematic sides first.
class BodyOrder {
 public:
  explicit BodyOrder(int bodies) : after_(index(bodies)) {}
  void add(int before, int after) { after_[before].push_back(after); }
  bool comes_before(int before, int after) const;  // a body comes before itself
  void state(Archive& archive);

 private:
  std::vector<std::vector<int>> after_;  // by body, without circles
};

/// Chooses the kinematic sides of joints whose roles the scene leaves open (docs/METHOD.md, roles):
/// of contact the softer or lighter side, told by what a constant unit force moves over a window
/// (port kernels); within a factor of 3 the one with the finer mesh, then the finer step, then the
/// first. Of ties with unlike steps the side of the larger one: its force then varies no faster
/// than it steps, and the other side's means of it take nothing away; with the roles exchanged the
/// trapezoidal rule gains energy over 1e5 substeps. A side that takes no obstacles never is.
///
/// The roles are those of one order of the bodies: a joint that would close a circle is turned
/// around.
class Roles {
 public:
  /// `window` [s]: a whole one; `parallel`: forces are iterated, at the coarser side's substeps.
  Roles(Bodies& bodies, double window, bool parallel)
      : bodies_(bodies), window_(window), parallel_(parallel), order_(bodies.count()) {}

  /// Before the first window: what the scene fixes, what only one side can take, and ties. Throws
  /// InputError where that goes round in a circle.
  void start(std::span<Joint> joints);
  /// Of surfaces, where it is open: for the rest of the run. Throws as start does.
  void join(Joint& joint);
  /// At first touch, for the rest of the run; true when the role was open.
  bool choose(Joint& joint);
  /// Roles of a stage before, which the joints have: what presses stays with the side that has
  /// found it. False, and nothing is changed: a side does not find contact any more, or there are
  /// ties, whose roles are of their steps.
  bool keep(std::span<const Joint> joints);
  /// The order of the bodies.
  void state(Archive& archive) { order_.state(archive); }

 private:
  int wish(const Joint& joint);
  void settle(Joint& joint, int kinematic, bool may_turn);

  Bodies& bodies_;
  double window_;
  bool parallel_;
  BodyOrder order_;
};

/// The side of shorter steps; none: they are equal, or one side stands or goes where it is told.
std::optional<int> shorter_steps(const Joint& joint, const Bodies& bodies);

/// Of two surfaces, the side that finds their contact: the scene's, or the only one that can, or
/// the one that was adjusted, since its rows touch then. Of bodies without inertia that contact
/// holds the one nearest to what supports hold finds all its contacts, for one problem of all its
/// rows knows how it moves as a whole. That of shorter steps does, for where
/// contact begins and ends is known to the steps of the finder. Of equal ones a body whose port
/// kernel is exact is pressed, the other finds; of two such that of the finer mesh does. Circles of
/// bodies may turn it.
int contact_finder(const Joint& joint, const Bodies& bodies);

/// Index of the side whose substeps carry the force in the parallel form: the one with the longer
/// steps.
int coarser_side(const Joint& joint, const Bodies& bodies);

/// Stable step [s] of an explicit Neumann side whose massive node takes the kinematic side's
/// contact spring beside its own: by Gershgorin's rows, 2 / sqrt(w^2 + k / m)  [M.53]. Infinity
/// where the side is implicit, or has a contact layer of its own, or the partner is no spring.
double stable_step_in_contact(const Joint& joint, Bodies& bodies, double length);

}  // namespace abut
