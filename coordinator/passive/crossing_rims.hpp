#pragma once

#include <vector>

#include "base/archive.hpp"
#include "coordinator/passive/edge_row.hpp"
#include "surface/near_features.hpp"

namespace abut {

/// Rims that cross on each other, as those of boxes that are stacked crosswise: the corners of what
/// faces have in common that are no corner of either. Where faces touch to the last digits such a
/// pair has no distance that could be kept, and no end behind the partner, so it is held by a row
/// of its signed gap, until it is out or its edges pass each other elsewhere [M.165].
class CrossingRims {
 public:
  using Places = std::vector<Eigen::Vector3d>;

  /// `thickness` [m] as in NearRows. Of the pairs that `choice` allows.
  CrossingRims(const TouchingSurfaces& surfaces, double thickness, FeatureChoice choice);

  /// Where the surfaces are when the passive way begins.
  void begin(SkinTrees& trees, const Places& places);
  /// A step was taken: what is out, or crosses no more, is no longer held, and the next edges of
  /// the same rims are.
  void accept(SkinTrees& trees, const Places& places);
  /// Whether a pair is held, so that no distance of it is kept.
  bool holds(const FeaturePair& pair) const;
  /// Adds the rows of a step, but for those that are there.
  void find(const Places& from, std::vector<DistanceRow>& rows) const;
  /// How many are deeper at the end of a step than at its begin, and rows of there.
  int check(const Places& from, const Places& to, std::vector<DistanceRow>& rows) const;
  void state(Archive& archive);

 private:
  using Points = std::array<std::int32_t, 4>;

  void see(SkinTrees& trees, const Places& places);
  bool faces(const DistanceRow& row, const Places& places) const;

  const TouchingSurfaces& surfaces_;
  double thickness_, rounding_;  // [m]
  FeatureChoice choice_;
  SkinSides sides_;
  std::vector<Points> pairs_;  // ascending
  std::vector<FeaturePair> near_;
};

}  // namespace abut
