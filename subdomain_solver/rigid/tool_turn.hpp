#pragma once

#include <functional>

#include <Eigen/Core>

namespace abut {

/// How a tool turns: with R the rotation about an axis through a point that goes the tool's way,
/// points are displaced by that way and by (R - 1) arm, their arm being that from the point.
class ToolTurn {
 public:
  using Angle = std::function<double(double)>;  // [rad] of time [s]

  /// `about` [m]; `axis` of any length.
  ToolTurn(Angle angle, Eigen::Vector3d about, const Eigen::Vector3d& axis);

  double angle(double time) const { return angle_(time); }
  const Eigen::Vector3d& about() const { return about_; }
  const Eigen::Vector3d& axis() const { return axis_; }
  /// R(to) - R(from), to round-off of what it is: small turns keep their digits.
  Eigen::Matrix3d between(double from, double to) const;

 private:
  Angle angle_;
  Eigen::Vector3d about_, axis_;
  Eigen::Matrix3d across_;  // axis x
};

}  // namespace abut
