#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/archive.hpp"
#include "coordinator/coupling/joint.hpp"
#include "surface/boxes.hpp"

namespace abut {

/// The points of a joint's Neumann side that contact may reach: those near the kinematic side's
/// facets, those that are pressed, and some facets around both. Only they give way by a port
/// kernel, whose cost is the square of their number.
class ContactZone {
 public:
  /// `margin` [m]: rows of facets may press before these touch.
  explicit ContactZone(double margin) : margin_(margin) {}

  /// For a window that moves the two sides by `way` [m] relative to each other. `k`, `n`: [m]
  /// (points, dim) displacements of the two sides at its begin, `pressed`: [N] the force on n then.
  /// A point that has come near or is pressed without being in the zone makes a new one.
  void see(const Joint& joint, const Bodies& bodies, std::span<const double> k,
           std::span<const double> n, std::span<const double> pressed, double way);
  void state(Archive& archive);
  /// Nothing has come near yet.
  bool empty() const { return !all_ && points_.empty(); }
  /// Ascending; all points of the side where that is empty and the zone is not.
  const std::vector<std::int32_t>& points() const { return points_; }

 private:
  bool holds(std::span<const double> k, std::span<const double> n, std::span<const double> pressed,
             double reach) const;
  double clearance(double most) const;
  std::vector<std::int32_t> reached(double reach, std::span<const double> pressed) const;
  std::vector<std::int32_t> around(const std::vector<std::int32_t>& points, double reach) const;

  double margin_;
  bool all_ = false;
  std::vector<std::int32_t> points_;
  // Of the last look: displacements [m], and how near to the kinematic side all points are in the
  // zone [m].
  std::vector<double> seen_k_, seen_n_;
  double clear_ = 0.0;
  std::vector<double> pose_k_, pose_n_;  // [m]
  PosedSurface k_, n_;
  BoxTree tree_;
};

}  // namespace abut
