#include "coordinator/passive/sliding_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace abut {

namespace {

/// Of what a row holds at most along its surfaces: sweeps leave as much.
constexpr double at_its_edge = 1.0 - 1.0e-6;

}  // namespace

double SlidingPoints::coefficient(const DistanceRow& row, double along, double rest) const {
  const std::array<std::int32_t, 2> first{row.first_point(0), row.first_point(1)};
  const double kinetic = surfaces_.friction(first[0], first[1]);
  const double sticking = surfaces_.static_friction(first[0], first[1]);
  if (!(sticking > kinetic)) return kinetic;
  const bool slid = fresh_ ? along > rest : std::ranges::any_of(first, [this](std::int32_t point) {
    return slid_.contains(point);
  });
  return slid ? kinetic : sticking;
}

void SlidingPoints::see(const DistanceRow& row, double along, double rest) {
  const double held = std::hypot(row.tangential_impulse[0], row.tangential_impulse[1]);
  if (row.friction > 0.0 && row.normal_impulse > 0.0 && along > rest &&
      held >= at_its_edge * row.friction * row.normal_impulse)
    for (const int side : {0, 1}) noted_.insert(row.first_point(side));
}

void SlidingPoints::next_step() {
  slid_ = std::move(noted_);
  noted_.clear();
  fresh_ = false;
}

void SlidingPoints::clear() {
  slid_.clear();
  noted_.clear();
  fresh_ = true;
}

void SlidingPoints::state(Archive& archive) {
  std::vector<double> slid(slid_.begin(), slid_.end());
  archive.field("slid", slid);
  slid_.clear();
  for (const double point : slid) slid_.insert(static_cast<std::int32_t>(point));
  archive.field("fresh", fresh_);
}

}  // namespace abut
