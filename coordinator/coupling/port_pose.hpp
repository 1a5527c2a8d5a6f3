#pragma once

#include <vector>

#include <Eigen/Core>

#include "contract/outcome.hpp"
#include "contract/port.hpp"
#include "surface/boxes.hpp"
#include "surface/posed_surface.hpp"

namespace abut {

/// Where the surface of a port stands when a reply ends, and how fast it moved in it.
class PortPose {
 public:
  /// Does nothing when it has seen and not forgotten. Precondition: the trace holds u and v of all
  /// points.
  void see(const PortGeometry& geometry, const Waveform& trace);
  void forget() { seen_ = false; }

  PosedSurface surface() const { return posed(*geometry_, points_); }
  const BoxTree& tree() const { return tree_; }  // boxes without a margin
  /// [m/s] A ball that holds the velocities of all points at all times of the reply.
  const Eigen::Vector3d& velocity() const { return velocity_; }
  double spread() const { return spread_; }

 private:
  void see_velocities(const Waveform& trace);

  bool seen_ = false;
  const PortGeometry* geometry_ = nullptr;
  std::vector<double> points_;  // [m]
  BoxTree tree_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  // [m/s]
  double spread_ = 0.0;                                 // [m/s]
};

}  // namespace abut
