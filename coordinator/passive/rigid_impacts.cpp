#include "coordinator/passive/rigid_impacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "coordinator/coupling/state_fields.hpp"
#include "coordinator/passive/row_impulses.hpp"

namespace abut {

namespace {

/// Of the velocity that was aimed at: what sweeps leave.
constexpr double reached = 1.0e-6;
/// Cosine of what neighbouring facets of a round surface are turned by at most.
constexpr double nearly_along = 0.99999;

Eigen::Vector3d friction_of(const DistanceRow& row) {
  return row.tangential_impulse[0] * row.tangents[0] + row.tangential_impulse[1] * row.tangents[1];
}

}  // namespace

RigidImpacts::RigidImpacts(const TouchingSurfaces& surfaces, const Bodies& bodies)
    : surfaces_(surfaces), bodies_(bodies) {}

bool RigidImpacts::are_rigid(const DistanceRow& row) const {
  if (row.behind || surfaces_.skin().dim == 1) return false;
  return std::ranges::none_of(std::array{0, 1}, [&](int side) {
    const TouchingSurfaces::Point& at = surfaces_[row.first_point(side)];
    return bodies_.port({at.body, at.port}).geometry.transit > 0.0;
  });
}

/// Those of the same features first. What slides from one facet to the next has another row, along
/// nearly the same normal.
void RigidImpacts::aim(std::span<DistanceRow> rows, std::span<const Eigen::Vector3d> begin,
                       std::span<const Eigen::Vector3d> free) const {
  if (now_.empty()) return;
  Impacts left = now_;
  for (DistanceRow& row : rows)
    if (const auto found = left.extract(row.key()); found && are_rigid(row))
      aim(row, found.mapped(), begin, free);
  for (const auto& [key, impact] : left) {
    const auto is_next = [&](const DistanceRow& row) {
      return !row.aimed && key[1] >= 0 && row.key()[1] == key[1] && are_rigid(row) &&
             row.normal.dot(impact.normal) > nearly_along;
    };
    if (const auto next = std::ranges::find_if(rows, is_next); next != rows.end())
      aim(*next, impact, begin, free);
  }
}

/// Loads change velocities in a step by twice what they change its mean.
void RigidImpacts::aim(DistanceRow& row, const Impact& impact,
                       std::span<const Eigen::Vector3d> begin,
                       std::span<const Eigen::Vector3d> free) const {
  row.aimed = true;
  row.aim = row_velocity(row, free, 0) + 0.5 * (impact.parting - row_velocity(row, begin, 0));
  row.parting = impact.parting;
  row.pushed = impact.pushed;
  row.heat = impact.heat;
  for (const std::size_t t : {0u, 1u}) row.rubbed[t] = impact.rubbed.dot(row.tangents[t]);
}

void RigidImpacts::begin(const DistanceRow& row, double approach, double heat) {
  const double restitution = surfaces_.restitution(row.first_point(0), row.first_point(1));
  noted_[row.key()] = {restitution * std::max(0.0, approach), row.normal_impulse, heat,
                       friction_of(row), row.normal};
}

void RigidImpacts::follow(const DistanceRow& row, double velocity, double heat) {
  const double left = std::abs(velocity - row.aim);
  if (left <= reached * std::max(std::abs(row.aim), std::abs(row.parting))) return;
  const double pushed = row.pushed + row.normal_impulse;
  const Eigen::Vector3d before = row.rubbed[0] * row.tangents[0] + row.rubbed[1] * row.tangents[1];
  if (pushed > 0.0)
    noted_[row.key()] = {row.parting, pushed, std::max(0.0, row.heat + heat),
                         before + friction_of(row), row.normal};
}

void RigidImpacts::next_step() {
  now_ = std::move(noted_);
  noted_.clear();
}

void RigidImpacts::clear() {
  now_.clear();
  noted_.clear();
}

void RigidImpacts::state(Archive& archive) {
  std::vector<std::pair<DistanceRow::Key, Impact>> impacts(now_.begin(), now_.end());
  list(archive, "impacts", impacts, [](Archive& a, auto& each) {
    for (std::int32_t& part : each.first) whole(a, "key", part);
    a.field("parting", each.second.parting);
    a.field("pushed", each.second.pushed);
    a.field("heat", each.second.heat);
    for (double& part : each.second.rubbed) a.field("rubbed", part);
    for (double& part : each.second.normal) a.field("normal", part);
  });
  now_ = {impacts.begin(), impacts.end()};
}

}  // namespace abut
