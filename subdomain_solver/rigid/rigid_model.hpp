#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/rigid/free_rotation.hpp"

namespace abut {

/// Place of a rigid body: how its centre of mass is displaced and how it is turned about it.
struct Pose {
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  // [m]
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();
};

/// Velocities of a rigid body, along the axes of space; or its accelerations.
struct Twist {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // [m/s] of the centre of mass
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();   // [rad/s]
};

/// A body that does not deform [M.60]: M v' = f, without internal force. In one dimension and in
/// the plane v is q', as of any model; in space, where an attitude is no vector, RigidMotion tells
/// how q follows from v. About the axes of space, moments and angular momentum about the centre:
///
///  - 1D: q displacement of the centre [m]; v its rate; f force [N]
///  - 2D: q displacement (2) and angle [rad]; v their rates; f force (2) and moment [N m]
///  - 3D: q displacement (3) and attitude as a unit quaternion w, x, y, z (4); v velocity (3) and
///    angular momentum [kg m^2/s] (3); f force (3) and moment (3)
///
/// Angular momentum is a number of its own so that round-off cannot change it.
class RigidModel final : public Model {
 public:
  /// Mass, centre and inertia of a mesh by its mass matrix: rigid motions then have the momenta and
  /// the kinetic energy that they have in finite elements. Not for axisymmetric ones.
  RigidModel(const FeModel& mesh, MassForm form);

  int dofs() const override { return static_cast<int>(lumped_.size()); }
  bool is_linear() const override { return true; }
  std::size_t history_size() const override { return 0; }
  const SparseMatrix& mass() const override { return mass_; }
  const Vector& lumped_mass() const override { return lumped_; }
  double roundoff(std::span<const double>) const override { return 0.0; }
  [[nodiscard]] bool evaluate(std::span<const double> q, std::span<const double> history, Want want,
                              ModelResponse& out) override;

  int dim() const { return dim_; }
  double total_mass() const { return lumped_(0); }           // [kg]
  const Eigen::Vector3d& centre() const { return centre_; }  // [m] of mass, reference
  /// Inertia about the centre, along the axes of space, in an attitude [kg m^2]. In the plane the
  /// last entry alone is not zero; in one dimension none is.
  Eigen::Matrix3d inertia(const Eigen::Quaterniond& attitude) const;

  /// Angular velocity [rad/s] of an angular momentum [kg m^2/s] about the centre, in space.
  Eigen::Vector3d angular_velocity(const Eigen::Quaterniond& attitude,
                                   const Eigen::Vector3d& momentum) const;

  Pose pose(std::span<const double> q) const;
  Twist twist(std::span<const double> q, std::span<const double> v) const;
  /// Accelerations, where a = dv/dt.
  Twist acceleration(std::span<const double> q, std::span<const double> v,
                     std::span<const double> a) const;
  /// [kg m^2/s] about the centre.
  Eigen::Vector3d angular_momentum(std::span<const double> v) const;
  double kinetic(std::span<const double> q, std::span<const double> v) const;  // [J]
  /// [W] of a force and moment (dofs) on the moving body.
  double power(std::span<const double> q, std::span<const double> v, const Vector& force) const;

  std::vector<double> coordinates(const Pose& pose) const;
  std::vector<double> rates(const Pose& pose, const Twist& twist) const;

  /// Moves q by a time [s] in which no force acts: exact to round-off [M.61, M.62].
  void drift(std::span<double> q, std::span<const double> v, double time) const;
  /// [rad/s] that the body does not turn faster than while no force acts.
  double fastest_turn(std::span<const double> q, std::span<const double> v) const;

 private:
  int dim_;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond axes_ = Eigen::Quaterniond::Identity();  // turn to the principal axes
  std::optional<FreeRotation> rotation_;                      // in space
  Vector lumped_;                                             // (dofs)
  SparseMatrix mass_;
};

}  // namespace abut
