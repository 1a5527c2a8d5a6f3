#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "base/archive.hpp"
#include "coordinator/passive/distance_row.hpp"
#include "coordinator/passive/touching_surfaces.hpp"
#include "surface/intersections.hpp"
#include "surface/near_features.hpp"
#include "surface/signed_side.hpp"

namespace abut {

/// What is behind a partner's surface, or on it, when the passive way begins: points, and in space
/// edges that pass through it with both ends outside. Each is held by a row along its shortest way
/// out, so that it goes no deeper, until it is out. Only its own distances from that one surface
/// are not kept above zero meanwhile: they are those of the other side [M.138].
class BehindRows {
 public:
  using Places = std::vector<Eigen::Vector3d>;

  /// `thickness` [m] as in NearRows. Of the pairs that `choice` allows.
  BehindRows(const TouchingSurfaces& surfaces, double thickness, FeatureChoice choice);

  /// Where the surfaces are when the passive way begins.
  void begin(SkinTrees& trees, const Places& places);
  /// A step was taken: what is out is no longer behind.
  void accept(SkinTrees& trees, const Places& places);
  /// Whether one of a pair's features is behind the other one's surface, or on it.
  bool holds(const FeaturePair& pair) const;
  /// A pair comes near beside what is held: if its feature is on the surface at the step's end, it
  /// is held as well from then on.
  void let_beside(const FeaturePair& pair);
  /// Whether a pair's distance is one of those that are not kept in a step from `places`, which the
  /// trees' boxes hold.
  bool leaves_out(const SkinTrees& trees, const FeaturePair& pair, const Places& places) const;
  /// Adds the rows of a step.
  void find(SkinTrees& trees, const Places& from, std::vector<DistanceRow>& rows);
  /// How many are deeper at the end of a step than at its begin, and rows of there.
  int check(SkinTrees& trees, const Places& from, const Places& to, std::vector<DistanceRow>& rows);
  void state(Archive& archive);

 private:
  struct Behind {
    std::array<std::int32_t, 2> points{-1, -1};     // one, or those of an edge
    std::int32_t group = -1;                        // behind which one
    double gap = 0.0;                               // [m] along its way out
    Eigen::Vector3d out = Eigen::Vector3d::Zero();  // unit: its way out; zero: not known yet
    std::array<std::int32_t, 2> edge{-1, -1};       // of an edge: the one that it has to pass
    bool comes = false;                             // beside others, in this step

    bool is_edge() const { return points[1] >= 0; }
    auto key() const { return std::pair(points, group); }
  };
  /// Of one of them at a pose.
  struct WayOut {
    DistanceRow row;
    int rank = 0;  // 0: there is none
    double distance = 0.0, against = 0.0;
    double nearest = std::numeric_limits<double>::infinity();  // [m] of all facets that were seen
  };

  const Behind* known(std::array<std::int32_t, 2> points, std::int32_t group) const;
  bool leaves_out(std::array<std::int32_t, 2> edge, std::int32_t group) const;
  bool passes_outside(const SkinTrees& trees, const FeaturePair& pair, const Places& places) const;
  SignedSide side_of(const SkinTrees& trees, const Places& places, const Eigen::Vector3d& x,
                     std::int32_t group) const;
  SignedSide side_of(const SkinTrees& trees, const Places& places, const Behind& what) const;
  bool is_before_another(const SkinTrees& trees, const Places& places, Behind what,
                         double depth) const;
  bool stays(const SkinTrees& trees, const Places& places, const Behind& what, const WayOut& way,
             double least) const;
  static void hold(Behind& what, const WayOut& way);
  void add_points(const SkinTrees& trees, const Places& places);
  std::vector<Behind> edges_through(SkinTrees& trees, const Places& places, double least);
  void take(std::vector<Behind> behind);
  void gather(SkinTrees& trees, const Places& from, const Places& to);
  WayOut way_out(std::size_t k, const Places& places) const;
  void see_facet(const Behind& what, std::int32_t facet, const Places& places, WayOut& best) const;
  void see_edge(const Behind& what, const std::array<std::int32_t, 2>& edge, const Places& places,
                WayOut& best) const;

  const TouchingSurfaces& surfaces_;
  double thickness_, rounding_;  // [m]
  FeatureChoice choice_;
  SkinSides sides_;
  std::vector<std::uint8_t> closed_;  // (groups) whether the surface ends nowhere
  std::vector<Behind> behind_;        // ascending by key
  std::vector<Behind> beside_;        // what comes in this step
  std::vector<std::uint8_t> flags_;   // (points) one of them
  bool any_edges_ = false;
  double reach_ = 0.0;                             // [m] how far ways out are looked for
  std::vector<std::vector<std::int32_t>> around_;  // by place in behind_: facets, or edges
  std::vector<Intersection> crossing_;
  std::vector<FeaturePair> pairs_;
};

}  // namespace abut
