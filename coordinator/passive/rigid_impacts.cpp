#include "coordinator/passive/rigid_impacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "coordinator/coupling/state_fields.hpp"
#include "coordinator/passive/row_impulses.hpp"

namespace abut {

namespace {

/// Of the velocity with which the sides came: what sweeps leave where rows say the same.
constexpr double reached = 1.0e-4;
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
/// nearly the same normal. What a joint holds moves by the joint's impulses beside its own loads,
/// which are found with those of the rows: there the velocity of the begin stands for both.
void RigidImpacts::aim(std::span<DistanceRow> rows, std::span<const Eigen::Vector3d> begin,
                       std::span<const Eigen::Vector3d> free, const PassiveTies& ties) const {
  if (now_.empty()) return;
  const auto aim_at = [&](DistanceRow& row, const Impact& impact) {
    const bool joined = std::ranges::any_of(std::array{0, 1}, [&](int side) {
      return ties.joined(surfaces_[row.first_point(side)].body);
    });
    aim(row, impact, row_velocity(row, begin, 0), row_velocity(row, joined ? begin : free, 0));
  };
  Impacts left = now_;
  for (DistanceRow& row : rows)
    if (const auto found = left.extract(row.key()); found && are_rigid(row))
      aim_at(row, found.mapped());
  for (const auto& [key, impact] : left) {
    const auto is_next = [&](const DistanceRow& row) {
      return !row.aimed && key[1] >= 0 && row.key()[1] == key[1] && are_rigid(row) &&
             row.normal.dot(impact.normal) > nearly_along;
    };
    if (const auto next = std::ranges::find_if(rows, is_next); next != rows.end())
      aim_at(*next, impact);
  }
}

/// Loads change velocities in a step by twice what they change its mean. `begin`, `free`: [m/s] of
/// the row.
void RigidImpacts::aim(DistanceRow& row, const Impact& impact, double begin, double free) const {
  row.aimed = true;
  row.aim = free + 0.5 * (impact.parting - begin);
  row.parting = impact.parting;
  row.approach = impact.approach;
  row.pushed = impact.pushed;
  row.heat = impact.heat;
  for (const std::size_t t : {0u, 1u}) row.rubbed[t] = impact.rubbed.dot(row.tangents[t]);
}

void RigidImpacts::begin(const DistanceRow& row, double approach, double heat) {
  const double restitution = surfaces_.restitution(row.first_point(0), row.first_point(1));
  approach = std::max(0.0, approach);
  noted_[row.key()] = {approach, restitution * approach, row.normal_impulse,
                       heat,     friction_of(row),       row.normal};
}

void RigidImpacts::follow(const DistanceRow& row, double velocity, double heat) {
  if (std::abs(velocity - row.aim) <= reached * row.approach) return;
  const double pushed = row.pushed + row.normal_impulse;
  const Eigen::Vector3d before = row.rubbed[0] * row.tangents[0] + row.rubbed[1] * row.tangents[1];
  if (pushed > 0.0)
    noted_[row.key()] = {row.approach,
                         row.parting,
                         pushed,
                         std::max(0.0, row.heat + heat),
                         before + friction_of(row),
                         row.normal};
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
    a.field("approach", each.second.approach);
    a.field("parting", each.second.parting);
    a.field("pushed", each.second.pushed);
    a.field("heat", each.second.heat);
    for (double& part : each.second.rubbed) a.field("rubbed", part);
    for (double& part : each.second.normal) a.field("normal", part);
  });
  now_ = {impacts.begin(), impacts.end()};
}

}  // namespace abut
