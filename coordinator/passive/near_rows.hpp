#pragma once

#include <map>
#include <span>
#include <vector>

#include "coordinator/passive/distance_row.hpp"
#include "coordinator/passive/own_gaps.hpp"
#include "coordinator/passive/touching_surfaces.hpp"
#include "surface/intersections.hpp"
#include "surface/near_features.hpp"
#include "surface/signed_side.hpp"

namespace abut {

/// Of the shortest edge: how near surfaces press [M.134].
constexpr double thickness_share = 1.0e-3;

/// Finds what must be kept apart in a step, and checks the ways that the surfaces take [M.134].
/// Distances have no inside: a row is the shortest way between two features, so thin, open and
/// folded surfaces and spikes need no rule. Points that are behind a partner's surface when the
/// passive way begins, or on it, have rows along the outward normal of that surface until they are
/// out again; nothing else is asked of their ways.
class NearRows {
 public:
  using Places = std::vector<Eigen::Vector3d>;

  /// `thickness` [m]: surfaces nearer than this press if they come closer.
  NearRows(const TouchingSurfaces& surfaces, double thickness);

  double thickness() const { return thickness_; }
  /// Where the surfaces are when the passive way begins.
  void begin(const Places& places);
  /// The step's first rows: of what is near,
  void find(const Places& from, std::vector<DistanceRow>& rows);
  /// and of what free ways bring near.
  void find_on_ways(const Places& from, const Places& to, std::vector<DistanceRow>& rows);
  /// Pairs whose ways bring them closer than may be; adds rows of the moments at which they do.
  struct Crossed {
    int pairs = 0, added = 0;
  };
  Crossed check(const Places& from, const Places& to, std::vector<DistanceRow>& rows);
  /// The step was taken.
  void accept(const Places& places);
  void state(Archive& archive);

 private:
  /// Of a pair at a part of the way, as the features are there.
  bool add(const FeaturePair& pair, const Places& from, const Places& to, double part,
           std::vector<DistanceRow>& rows);
  void add_behind(const Places& from, std::vector<DistanceRow>& rows);
  void add_facing(std::int32_t node, const Places& from, std::vector<DistanceRow>& rows) const;
  bool leaves_out(const FeaturePair& pair) const;
  bool known(const DistanceRow& row, const std::vector<DistanceRow>& rows) const;
  void name(const std::vector<DistanceRow>& rows);
  void mark_behind(const Places& places, const std::vector<std::uint8_t>& may_be);

  const TouchingSurfaces& surfaces_;
  double thickness_;
  SkinTrees trees_;
  OwnGaps own_;
  SkinSides sides_;
  std::vector<Intersection> crossing_;
  std::vector<std::vector<std::int32_t>> around_;  // (points) facets that a behind node is near
  std::vector<FeaturePair> pairs_;
  std::multimap<DistanceRow::Key, std::size_t> named_;  // places of the step's rows
  std::vector<std::uint8_t> behind_;  // (points) begins behind a partner's surface
  int behind_count_ = 0;
};

}  // namespace abut
