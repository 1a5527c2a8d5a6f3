#include "coordinator/passive/distance_row.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "base/index.hpp"

namespace abut {

namespace {
constexpr double no_weight = 1.0e-9;  // a point that takes less has no part in the row
}

void DistanceRow::find_tangents(int dim) {
  if (dim == 2) {
    tangents = {Eigen::Vector3d(-normal.y(), normal.x(), 0.0), Eigen::Vector3d::Zero()};
    return;
  }
  const Eigen::Vector3d aside =
      std::abs(normal.x()) < 0.7 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  tangents[0] = normal.cross(aside).normalized();
  tangents[1] = normal.cross(tangents[0]);
}

DistanceRow::Key DistanceRow::key() const {
  Key key = {static_cast<std::int32_t>(features.kind), -1, -1, -1, -1};
  for (std::size_t i = 0; i < 4; ++i)
    if (std::abs(weights[i]) > no_weight) key[i + 1] = features.points[i];
  if (features.kind == FeatureKind::node_facet) std::sort(key.begin() + 2, key.end());
  return key;
}

}  // namespace abut
