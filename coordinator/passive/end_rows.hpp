#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "coordinator/passive/distance_row.hpp"
#include "coordinator/passive/touching_surfaces.hpp"

namespace abut {

/// Rows of bodies in one dimension, whose surfaces are points: two ends that face each other are
/// apart by a length with a sign, so that ends that are in each other need no rule of their own.
/// What NearRows does for surfaces of facets; nothing where the skin has more dimensions.
class EndRows {
 public:
  using Places = std::vector<Eigen::Vector3d>;

  /// `thickness` [m] as in NearRows.
  EndRows(const TouchingSurfaces& surfaces, double thickness);

  /// Adds rows of ends that are nearer than `reach` [m] at the step's begin and have none.
  void find(const Places& from, double reach, std::vector<DistanceRow>& rows) const;
  /// The same of ends whose ways bring them nearer than the thickness.
  void find_on_ways(const Places& from, const Places& to, std::vector<DistanceRow>& rows) const;
  /// Pairs that come too near, and how many of them had no row; that is added.
  struct Crossed {
    int pairs = 0, added = 0;
  };
  /// Of those whose ways bring them into each other, or deeper, by more than rows are missed.
  Crossed check(const Places& from, const Places& to, std::vector<DistanceRow>& rows) const;

 private:
  struct Pair {
    std::int32_t one = 0, other = 0;  // points
    double outward = 0.0;             // of the first, +1 or -1 along x
  };
  static double gap(const Pair& pair, const Places& places) {
    return pair.outward * (places[index(pair.other)].x() - places[index(pair.one)].x());
  }
  bool add(const Pair& pair, const Places& from, std::vector<DistanceRow>& rows) const;

  double thickness_;
  std::vector<Pair> pairs_;
};

}  // namespace abut
