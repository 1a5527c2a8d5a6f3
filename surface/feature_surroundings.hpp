#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "surface/feature_distance.hpp"
#include "surface/skin.hpp"

namespace abut {

/// [m] the points of a skin at a part of straight ways between two poses.
struct PartOfWay {
  std::span<const Eigen::Vector3d> from, to;
  double part = 0.0;

  Eigen::Vector3d operator[](std::int32_t point) const {
    const auto p = static_cast<std::size_t>(point);
    return from[p] + part * (to[p] - from[p]);
  }
};

/// Whether the closest points of two features are closest among what lies around them. That of a
/// facet may be on its edge, though the surface goes on beyond that edge and comes nearer there:
/// then the way between the two is no normal of the surface. The skin must live.
class FeatureSurroundings {
 public:
  explicit FeatureSurroundings(const Skin& skin);

  /// Whether around the closest point of a pair's side (0, 1) its surface goes nearer to the other
  /// side, at an angle whose sine is at least `sine`. `weights` as in FeatureDistance, `way` of
  /// length 1 from the second side's closest point to that of the first.
  bool goes_nearer(const FeaturePair& pair, const std::array<double, 4>& weights, int side,
                   const Eigen::Vector3d& way, double sine, const PartOfWay& places) const;
  /// All pairs of features of facets that have a point of the one side and of the other; some more
  /// than once.
  void visit_around(const FeaturePair& pair,
                    const std::function<void(const FeaturePair&)>& visit) const;

 private:
  /// Numbers by place, each place with a list of its own.
  struct Lists {
    std::vector<std::int32_t> offsets = {0}, numbers;

    std::span<const std::int32_t> of(std::size_t place) const {
      const auto begin = static_cast<std::size_t>(offsets[place]);
      return std::span(numbers).subspan(begin,
                                        static_cast<std::size_t>(offsets[place + 1]) - begin);
    }
    void add(const std::vector<std::int32_t>& list);
  };
  std::span<const std::int32_t> beside(std::int32_t one, std::int32_t other) const;
  std::vector<std::int32_t> facets_at(const FeaturePair& pair, int side) const;

  const Skin& skin_;
  Lists around_;  // (points) the other points of a point's facets
  Lists facets_;  // (points) a point's facets
  Lists beside_;  // (edges) the third points of an edge's facets
};

}  // namespace abut
