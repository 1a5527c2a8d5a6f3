#pragma once

#include <optional>
#include <span>
#include <vector>

#include "contract/outcome.hpp"
#include "subdomain_solver/rigid/rigid_model.hpp"
#include "subdomain_solver/time/problem.hpp"

namespace abut {

/// The passive step of a rigid body in the plane or in space [M.128]: half of the impulse, free
/// motion, which is exact, and the other half. Points of ports are moved from place to place;
/// impulses on them turn the body with just the arm with which they work on these ways.
class RigidStep {
 public:
  /// `arms`: [m] (points) of the ports from the centre of mass, before the body turns. What is
  /// referred to must outlive it.
  RigidStep(const RigidModel& body, std::vector<Eigen::Vector3d> arms,
            std::vector<const Load*> loads);

  /// `impulses`: [N s] (points, dim). When it fails the motion is as before.
  [[nodiscard]] std::optional<Failed> step(Motion& motion, double begin, double end,
                                           std::span<const double> impulses);
  /// [m] (points, dim) by which the last step moved the points.
  const std::vector<double>& moved() const { return moved_; }
  /// [m] by which they left the straight way at most.
  double bulge() const { return bulge_; }
  /// Compliance [M.129] of some of the values at the mean attitude, (values, values) row by row.
  void compliance(const std::vector<std::size_t>& values, std::vector<double>& out) const;

 private:
  struct Turn {                              // of the whole step
    std::vector<double> q, v;                // at its end
    Eigen::Quaterniond begin, end;           // attitudes
    Eigen::Vector3d mean = {0.0, 0.0, 0.0};  // [rad/s] that moments work on
    double most = 0.0;                       // [rad] that it turns at most
  };
  Turn turn(const Motion& motion, const Eigen::Vector3d& impulse,
            const Eigen::Vector3d& moment) const;
  Eigen::Vector3d moment_of(const Turn& turn, std::span<const double> impulses, double& size) const;
  void see(const Turn& turn, const Eigen::Vector3d& travel);
  Eigen::Vector3d at(std::span<const double> values, std::size_t point) const;

  const RigidModel& body_;
  std::vector<Eigen::Vector3d> arms_;
  std::vector<const Load*> loads_;
  double length_ = 0.0;  // [s]
  std::vector<double> moved_;
  std::vector<Eigen::Vector3d> mean_arms_;              // [m] (points)
  Eigen::Matrix3d mobility_ = Eigen::Matrix3d::Zero();  // [1/(kg m^2)] at the mean attitude
  double bulge_ = 0.0;
};

}  // namespace abut
