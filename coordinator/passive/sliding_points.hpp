#pragma once

#include <cstdint>
#include <set>

#include "base/archive.hpp"
#include "coordinator/passive/distance_row.hpp"
#include "coordinator/passive/touching_surfaces.hpp"

namespace abut {

/// Where what sticks has a coefficient of its own, which one a row has in a step: that of sliding
/// if one of its first points slid in the step before, else that of sticking where one stuck in it
/// [M.126]. What was not pressed in it slides where it moves along faster than what rests.
class SlidingPoints {
 public:
  explicit SlidingPoints(const TouchingSurfaces& surfaces) : surfaces_(surfaces) {}

  /// Of a row whose sides move at `along` [m/s] along each other at the step's begin; what rests is
  /// not faster than `rest` [m/s].
  double coefficient(const DistanceRow& row, double along, double rest) const;
  /// A row of a step, whose sides moved at `along` [m/s] in it: what is at the edge of its cone has
  /// slid, but for what rests: rigid bodies are pressed in some steps and at some points more than
  /// in and at others.
  void see(const DistanceRow& row, double along, double rest);
  /// What see() has noted is for the next step. Where nothing pressed in one step, what slid before
  /// goes on sliding: rigid bodies that rest are pressed in every other step.
  void next_step();
  void clear();
  void state(Archive& archive);

 private:
  const TouchingSurfaces& surfaces_;
  std::set<std::int32_t> slid_;           // in the step before
  std::set<std::int32_t> waited_;         // of these, where nothing pressed in it
  std::set<std::int32_t> held_;           // that stuck in the step before
  std::set<std::int32_t> noted_, stuck_;  // in this step
};

}  // namespace abut
