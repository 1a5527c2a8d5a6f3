#include "coordinator/passive/distance_row.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "base/index.hpp"

namespace abut {

namespace {
constexpr double no_weight = 1.0e-9;  // a point that takes less has no part in the row
constexpr double most_couple = 1.0;   // on a point, of the impulse
}  // namespace

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

/// Forces (I^-1 c) x x' on points at x' from their middle, I = sum of |x'|^2 1 - x' x'^T, have no
/// sum and the moment c. They are those of the facet, which turns with its surface, and of both
/// edges.
void DistanceRow::find_couples(int dim, const FeaturePoints& places) {
  const std::size_t first = features.kind == FeatureKind::edge_edge ? 0 : 1, count = index(dim) + 1;
  Eigen::Vector3d apart = Eigen::Vector3d::Zero(), middle = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) apart += weights[i] * places[i];
  for (std::size_t i = first; i < count; ++i) middle += places[i] / double(count - first);
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (std::size_t i = first; i < count; ++i) {
    const Eigen::Vector3d arm = places[i] - middle;
    inertia += arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose();
  }
  if (dim == 2) inertia = inertia(2, 2) * Eigen::Matrix3d::Identity();
  if (!(inertia.determinant() > 0.0)) return;
  const Eigen::Matrix3d inverse = inertia.inverse();
  for (std::size_t t = 0; t + 1 < index(dim); ++t) {
    const Eigen::Vector3d turn = -(inverse * apart.cross(tangents[t]));
    double most = 0.0;
    for (std::size_t i = first; i < count; ++i) {
      const Eigen::Vector3d couple = turn.cross(places[i] - middle);
      couples[t].col(static_cast<Eigen::Index>(i)) = couple;
      most = std::max(most, couple.norm());
    }
    if (most > most_couple) couples[t] *= most_couple / most;
    coupled = coupled || most > 0.0;
  }
}

DistanceRow::Key DistanceRow::key() const {
  Key key = {static_cast<std::int32_t>(features.kind), -1, -1, -1, -1};
  for (std::size_t i = 0; i < 4; ++i)
    if (std::abs(weights[i]) > no_weight) key[i + 1] = features.points[i];
  if (features.kind == FeatureKind::node_facet) std::sort(key.begin() + 2, key.end());
  return key;
}

}  // namespace abut
