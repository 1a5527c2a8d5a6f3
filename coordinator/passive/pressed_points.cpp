#include "coordinator/passive/pressed_points.hpp"

#include <algorithm>

namespace abut {

void PressedPoints::clear() {
  for (Body& body : bodies_) body.slots.clear();
  slots_.assign(surfaces_.count(), -1);
}

/// Points of the skin lie port by port, in the order of points: sorted as they are, so are the
/// values of a body whose ports were numbered in their order.
bool PressedPoints::add(const DistanceRow& row) {
  if (slots_.size() != surfaces_.count()) slots_.assign(surfaces_.count(), -1);
  bool grown = false;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::int32_t point = row.features.points[i];
    if (row.weights[i] == 0.0 || surfaces_.stands(point) || slots_[point] >= 0) continue;
    Body& body = bodies_[index(surfaces_[point].body)];
    const auto before = [this](std::int32_t a, std::int32_t b) {
      const TouchingSurfaces::Point &one = surfaces_[a], &other = surfaces_[b];
      return std::pair(one.port, one.point) < std::pair(other.port, other.point);
    };
    body.slots.insert(std::ranges::upper_bound(body.slots, point, before), point);
    const int dim = surfaces_.skin().dim;
    for (std::size_t k = 0; k < body.slots.size(); ++k)
      slots_[body.slots[k]] = static_cast<int>(k) * dim;
    grown = true;
  }
  return grown;
}

std::vector<std::vector<std::int32_t>> PressedPoints::list(int body, std::size_t ports) const {
  std::vector<std::vector<std::int32_t>> out(ports);
  for (const std::int32_t point : bodies_[index(body)].slots)
    out[index(surfaces_[point].port)].push_back(surfaces_[point].point);
  return out;
}

void PressedPoints::take(int body, const std::vector<double>& compliance, double softer,
                         std::span<const Eigen::Vector3d> velocities) {
  Body& to = bodies_[index(body)];
  const int dim = surfaces_.skin().dim;
  const Eigen::Index n = static_cast<Eigen::Index>(to.slots.size()) * dim;
  to.compliance = softer * Eigen::Map<const Eigen::MatrixXd>(compliance.data(), n, n);
  to.velocity.resize(n);
  for (std::size_t k = 0; k < to.slots.size(); ++k)
    for (int i = 0; i < dim; ++i)
      to.velocity(static_cast<Eigen::Index>(k) * dim + i) = velocities[to.slots[k]](i);
}

}  // namespace abut
