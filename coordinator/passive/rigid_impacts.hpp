#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "coordinator/coupling/bodies.hpp"
#include "coordinator/passive/distance_row.hpp"
#include "coordinator/passive/passive_ties.hpp"
#include "coordinator/passive/touching_surfaces.hpp"

namespace abut {

/// Impacts of rigid bodies on each other [M.161]. The impulse that closes a gap leaves them with
/// any speed between that of their approach and none, as the part of the step after which they
/// meet. What they shall part with, restitution says: so rows that have pressed are aimed at that
/// in the steps after, pulled by no more than they were pushed, until they have it; friction keeps
/// what Coulomb's law leaves of it.
class RigidImpacts {
 public:
  /// Both must outlive it.
  RigidImpacts(const TouchingSurfaces& surfaces, const Bodies& bodies);

  /// Whether neither side of a row deforms.
  bool are_rigid(const DistanceRow& row) const;
  /// Aims the rows of a step, which have no impulses yet, by their velocities [m/s] at its begin
  /// and mean ones when nothing presses and no joint holds (points).
  void aim(std::span<DistanceRow> rows, std::span<const Eigen::Vector3d> begin,
           std::span<const Eigen::Vector3d> free, const PassiveTies& ties) const;
  /// After a step: a row that pressed for the first time, coming at `approach` [m/s], with what
  /// its friction took [J].
  void begin(const DistanceRow& row, double approach, double heat);
  /// After a step: a row that was aimed, at its mean velocity; the impact is over when it has it.
  void follow(const DistanceRow& row, double velocity, double heat);
  /// What begin() and follow() have noted is for the next step; of others nothing is left.
  void next_step();
  void clear();
  void state(Archive& archive);

 private:
  struct Impact {
    double approach = 0.0;                             // [m/s] with which the sides came
    double parting = 0.0;                              // [m/s] that they shall part with
    double pushed = 0.0;                               // [N s] by which they were pushed so far
    double heat = 0.0;                                 // [J] of friction with that
    Eigen::Vector3d rubbed = Eigen::Vector3d::Zero();  // [N s] of it
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // of the row
  };
  using Impacts = std::map<DistanceRow::Key, Impact>;

  void aim(DistanceRow& row, const Impact& impact, double begin, double free) const;

  const TouchingSurfaces& surfaces_;
  const Bodies& bodies_;
  Impacts now_, noted_;
};

}  // namespace abut
