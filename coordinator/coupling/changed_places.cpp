#include "coordinator/coupling/changed_places.hpp"

#include <algorithm>
#include <array>

#include "coordinator/coupling/port_pose.hpp"

namespace abut {

namespace {

/// Of the coordinates: sides this near are at one place, and have not passed by parting.
constexpr double rounding_of_places = 1.0e-12;
/// Of the area of a side: as much of it looks one way where the side has a front at all.
constexpr double least_flat = 0.5;

struct Front {
  Eigen::Vector3d looks = Eigen::Vector3d::Zero();  // mean of the facets' normals
  Eigen::Vector3d at = Eigen::Vector3d::Zero();     // [m]
};

Front front_of(const PosedSurface& surface) {
  Front front;
  double whole = 0.0;
  for (int f = 0; f < surface.facet_count(); ++f) {
    const Corners c = corners(surface, f);
    front.looks += area_vector(c);
    front.at += area(c) * centre(c);
    whole += area(c);
  }
  if (whole > 0.0) front = {front.looks / whole, front.at / whole};
  return front;
}

/// Whether what was before a side is behind it now, or the other way round.
bool changed(const Front& side, const Front& other, const Front& side_now, const Front& other_now) {
  if (std::min(side.looks.norm(), side_now.looks.norm()) < least_flat) return false;
  const double none = -rounding_of_places * (side.at.norm() + other.at.norm());
  const double before = side.looks.dot(other.at - side.at);
  const double now = side_now.looks.dot(other_now.at - side_now.at);
  return (before > none) != (now > none);
}

}  // namespace

bool changed_places(const Joint& joint, const Bodies& bodies) {
  std::array<Front, 2> before, now;
  for (const std::size_t s : {0u, 1u}) {
    before[s] = front_of(posed(bodies.port(joint.sides[s]).geometry));
    now[s] = front_of(bodies.pose(joint.sides[s]).surface());
  }
  return changed(before[0], before[1], now[0], now[1]) ||
         changed(before[1], before[0], now[1], now[0]);
}

}  // namespace abut
