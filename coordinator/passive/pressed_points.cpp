#include "coordinator/passive/pressed_points.hpp"

#include <algorithm>
#include <tuple>

namespace abut {

void PressedPoints::clear() {
  for (Body& body : bodies_) body.slots.clear();
  slots_.assign(surfaces_.count(), -1);
}

bool PressedPoints::add(const DistanceRow& row) {
  constexpr int not_numbered = 0;
  if (slots_.size() != surfaces_.count()) slots_.assign(surfaces_.count(), -1);
  bool grown = false;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::int32_t point = row.features.points[i];
    if (!row.counts(i) || surfaces_.stands(point) || slots_[point] >= 0) continue;
    bodies_[index(owner(point))].slots.push_back(point);
    slots_[point] = not_numbered;
    grown = true;
  }
  return grown;
}

/// Points of the skin lie port by port, in the order of points: sorted as they are, so are the
/// values of a body whose ports were numbered in their order.
void PressedPoints::number() {
  const auto place = [this](std::int32_t point) {
    const TouchingSurfaces::Point& at = surfaces_[point];
    return std::tuple(at.body, at.port, at.point);
  };
  const int dim = surfaces_.skin().dim;
  for (Body& body : bodies_) {
    std::ranges::sort(body.slots, {}, place);
    for (std::size_t k = 0; k < body.slots.size(); ++k)
      slots_[body.slots[k]] = static_cast<int>(k) * dim;
  }
}

std::vector<std::vector<std::int32_t>> PressedPoints::list(int body, std::size_t ports) const {
  std::vector<std::vector<std::int32_t>> out(ports);
  for (const std::int32_t point : bodies_[index(owners_[index(body)])].slots)
    if (surfaces_[point].body == body)
      out[index(surfaces_[point].port)].push_back(surfaces_[point].point);
  return out;
}

std::vector<std::array<std::int32_t, 3>> PressedPoints::values(int owner) const {
  std::vector<std::array<std::int32_t, 3>> out;
  for (const std::int32_t point : bodies_[index(owner)].slots) {
    const TouchingSurfaces::Point& at = surfaces_[point];
    out.push_back({at.body, at.port, at.point});
  }
  return out;
}

void PressedPoints::take(int owner, const Eigen::Ref<const Eigen::MatrixXd>& compliance,
                         double softer, std::span<const Eigen::Vector3d> velocities) {
  Body& to = bodies_[index(owner)];
  to.bound.resize(0);
  to.compliance = softer * compliance;
  take_velocities(to, velocities);
}

void PressedPoints::take(int owner, const PassiveReply& reply, double softer,
                         std::span<const Eigen::Vector3d> velocities) {
  Body& to = bodies_[index(owner)];
  const std::size_t values = to.slots.size() * index(surfaces_.skin().dim);
  const auto size = static_cast<Eigen::Index>(values);
  const double* told = reply.compliance.data();
  if (!reply.bounds(values))
    return take(owner, Eigen::Map<const Eigen::MatrixXd>(told, size, size), softer, velocities);
  to.compliance.resize(0, 0);
  to.bound = Eigen::Map<const Eigen::VectorXd>(told, size);
  take_velocities(to, velocities);
}

void PressedPoints::take_velocities(Body& to, std::span<const Eigen::Vector3d> velocities) const {
  const int dim = surfaces_.skin().dim;
  to.velocity.resize(static_cast<Eigen::Index>(to.slots.size()) * dim);
  for (std::size_t k = 0; k < to.slots.size(); ++k)
    for (int i = 0; i < dim; ++i)
      to.velocity(static_cast<Eigen::Index>(k) * dim + i) = velocities[to.slots[k]](i);
}

std::optional<double> PressedPoints::of_its_own(std::int32_t point) const {
  const Body& body = bodies_[index(owner(point))];
  const int dim = surfaces_.skin().dim, first = slot(point);
  if (body.bound.size() >= first + dim) return body.bound.segment(first, dim).maxCoeff();
  if (body.compliance.rows() < first + dim) return std::nullopt;
  return body.compliance.diagonal().segment(first, dim).maxCoeff();
}

}  // namespace abut
