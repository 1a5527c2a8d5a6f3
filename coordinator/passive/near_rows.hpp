#pragma once

#include <map>
#include <span>
#include <vector>

#include "coordinator/passive/behind_rows.hpp"
#include "coordinator/passive/crossing_rims.hpp"
#include "coordinator/passive/distance_row.hpp"
#include "coordinator/passive/end_rows.hpp"
#include "coordinator/passive/own_gaps.hpp"
#include "coordinator/passive/touching_surfaces.hpp"
#include "surface/feature_surroundings.hpp"
#include "surface/near_features.hpp"

namespace abut {

/// Of the shortest edge: how near surfaces press [M.134].
constexpr double thickness_share = 1.0e-3;
/// The same of bodies without inertia, whose forces depend on places to that share.
constexpr double thickness_at_rest = 1.0e-4;

/// Finds what must be kept apart in a step, and checks the ways that the surfaces take [M.134].
/// Distances have no inside: a row is the shortest way between two features, so thin, open and
/// folded surfaces and spikes need no rule, but for what is behind a partner's surface when the
/// passive way begins (BehindRows).
class NearRows {
 public:
  using Places = std::vector<Eigen::Vector3d>;

  /// `thickness` [m]: surfaces nearer than this press if they come closer.
  NearRows(const TouchingSurfaces& surfaces, double thickness);

  double thickness() const { return thickness_; }
  /// Where the surfaces are when the passive way begins.
  void begin(const Places& places) {
    behind_.begin(trees_, places);
    crossing_.begin(trees_, places);
  }
  /// The step's first rows: of what is near,
  void find(const Places& from, std::vector<DistanceRow>& rows);
  /// and of what free ways bring near.
  void find_on_ways(const Places& from, const Places& to, std::vector<DistanceRow>& rows);
  using Crossed = EndRows::Crossed;
  /// Pairs whose ways bring them closer than may be, and what goes deeper behind a surface; adds
  /// rows of the moments at which they do.
  Crossed check(const Places& from, const Places& to, std::vector<DistanceRow>& rows);
  /// The step was taken.
  void accept(const Places& places) {
    behind_.accept(trees_, places);
    crossing_.accept(trees_, places);
  }
  void state(Archive& archive) {
    behind_.state(archive);
    crossing_.state(archive);
  }

 private:
  /// Of a pair at a part of the way, as the features are there.
  bool add(const FeaturePair& pair, const Places& from, const Places& to, double part,
           std::vector<DistanceRow>& rows);
  /// The same, unless a surface comes nearer beside the closest points: there the row would hold a
  /// node that slides inside of a flat side by an edge of its partner.
  void add_if_closest(const FeaturePair& pair, const Places& from, const Places& to, double part,
                      std::vector<DistanceRow>& rows);
  /// Whether a pair that comes as near as that only passes beside what is nearer yet: it may then
  /// come as near as is left to that one.
  bool passes_beside(const FeaturePair& pair, const Places& from, const Places& to, double part);
  double least(double distance) const;
  bool leaves_out(const FeaturePair& pair, const Places& from) const;
  bool known(const DistanceRow& row, const std::vector<DistanceRow>& rows) const;
  void name(const std::vector<DistanceRow>& rows);

  const TouchingSurfaces& surfaces_;
  double thickness_;
  SkinTrees trees_;
  FeatureSurroundings surroundings_;
  OwnGaps own_;
  BehindRows behind_;
  CrossingRims crossing_;
  EndRows ends_;
  std::vector<FeaturePair> pairs_;
  std::multimap<DistanceRow::Key, std::size_t> named_;  // places of the step's rows
};

}  // namespace abut
