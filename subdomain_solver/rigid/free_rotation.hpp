#pragma once

#include <Eigen/Geometry>

namespace abut {

/// Rotation of a body on which no torque acts, exact to round-off for any time [M.62]: Euler's
/// equations are quadratic, so that their Taylor series has a remainder that is known beforehand.
/// Needs no distinction between asymmetric bodies, tops, spheres, plates and the separatrix.
class FreeRotation {
 public:
  /// Principal second moments of mass, the integrals of x_i^2 dm [kg m^2], not negative: moments of
  /// inertia are their sums in pairs.
  explicit FreeRotation(const Eigen::Vector3d& second_moments);

  /// Moments of inertia about the principal axes [kg m^2].
  const Eigen::Vector3d& inertia() const { return inertia_; }

  /// The turn by which the body comes from its present attitude to that after a time [s], along its
  /// own principal axes; `momentum` is its angular momentum along them at the begin [kg m^2/s].
  /// The work is proportional to the angle turned.
  Eigen::Quaterniond turn(const Eigen::Vector3d& momentum, double time) const;

 private:
  Eigen::Quaterniond short_turn(const Eigen::Vector3d& scaled_velocity) const;

  Eigen::Vector3d inertia_;
  Eigen::Vector3d shape_;  // (I_j - I_k)/I_i of cyclic i, j, k: between -1 and 1
};

}  // namespace abut
