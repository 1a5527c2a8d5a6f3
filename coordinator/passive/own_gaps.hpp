#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "coordinator/passive/touching_surfaces.hpp"
#include "surface/near_features.hpp"

namespace abut {

/// How far bodies' surfaces are apart from themselves, so that they are looked at only where they
/// may have come upon themselves. Two points of a body come nearer to each other by no more than
/// twice what any of its points has moved, beside the motion that they have in common: since a look
/// at a pose that gap is a bound, for straight ways as for places. What is found depends on the
/// ways alone, not on when looks were taken.
class OwnGaps {
 public:
  using Places = std::span<const Eigen::Vector3d>;

  /// `thickness` [m]: pairs that are about as near as that in the reference belong to slits and
  /// slivers, and are never looked at.
  OwnGaps(const TouchingSurfaces& surfaces, double thickness);

  /// Pairs that may come within `reach` [m] on straight ways: those of different bodies, and those
  /// of a body with itself if it may come upon itself.
  const FeatureChoice& choice(SkinTrees& trees, Places from, Places to, double reach);
  /// Pairs of different bodies.
  const FeatureChoice& others() const { return others_; }
  bool leaves_out(const FeaturePair& pair) const;
  bool any() const { return !bodies_.empty(); }

 private:
  struct Body {
    FeatureChoice choice;                 // its own pairs alone
    std::vector<std::size_t> allowed;     // places of them in a choice
    std::vector<std::int32_t> nodes;      // of its groups
    double edge = 0.0;                    // [m] the shortest one
    double apart = 0.0;                   // [m] at the last look, at most an edge
    std::vector<Eigen::Vector3d> looked;  // (nodes) where they were then; empty: no look yet
    int near = 0;  // looks that are still to be left out: it was too near to itself
  };
  void find_bodies();
  bool may_meet(Body& body, SkinTrees& trees, Places from, Places to, double reach);
  static bool reaches(const Body& body, Places places, double reach);
  void look(Body& body, SkinTrees& trees, Places places);

  const TouchingSurfaces& surfaces_;
  std::vector<Body> bodies_;
  FeatureChoice others_, choice_;
  std::vector<FeaturePair> left_out_, pairs_;
};

}  // namespace abut
