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
  const double sticking = surfaces_.holding(first[0], first[1]);
  if (!(sticking > kinetic)) return kinetic;
  const auto any = [&first](const std::set<std::int32_t>& of) {
    return std::ranges::any_of(first, [&of](std::int32_t point) { return of.contains(point); });
  };
  if (any(slid_)) return kinetic;
  if (any(held_)) return sticking;
  return along > rest ? kinetic : sticking;
}

void SlidingPoints::see(const DistanceRow& row, double along, double rest) {
  if (!(row.friction > 0.0 && row.normal_impulse > 0.0)) return;
  const double held = std::hypot(row.tangential_impulse[0], row.tangential_impulse[1]);
  const bool slides = along > rest && held >= at_its_edge * row.friction * row.normal_impulse;
  for (const int side : {0, 1}) (slides ? noted_ : stuck_).insert(row.first_point(side));
}

void SlidingPoints::next_step() {
  std::erase_if(slid_, [this](std::int32_t point) {
    return stuck_.contains(point) || waited_.contains(point);
  });
  waited_ = slid_;
  for (const std::int32_t point : noted_) waited_.erase(point);
  slid_.merge(noted_);
  noted_.clear();
  held_ = std::exchange(stuck_, {});
}

void SlidingPoints::clear() {
  for (std::set<std::int32_t>* points : {&slid_, &waited_, &held_, &noted_, &stuck_})
    points->clear();
}

void SlidingPoints::state(Archive& archive) {
  for (std::set<std::int32_t>* points : {&slid_, &waited_, &held_}) {
    std::vector<double> list(points->begin(), points->end());
    archive.field("points", list);
    points->clear();
    for (const double point : list) points->insert(static_cast<std::int32_t>(point));
  }
}

}  // namespace abut
