#pragma once

#include <Eigen/Core>
#include <array>
#include <compare>
#include <cstdint>
#include <span>

#include "base/index.hpp"

namespace abut {

/// What can be closest to each other of two surfaces. In the plane a facet is a segment, and nodes
/// and facets say all; on a line it is a point.
enum class FeatureKind : std::uint8_t { node_facet, edge_edge };

/// Two features of a skin, by their points: a node and then its facet (in the plane the last is
/// -1, on a line the last two), or two edges. The node, or the first edge, is the pair's first
/// side.
struct FeaturePair {
  FeatureKind kind = FeatureKind::node_facet;
  std::array<std::int32_t, 4> points{-1, -1, -1, -1};

  /// How many points, from the first on, belong to the first side.
  int first_side() const { return kind == FeatureKind::node_facet ? 1 : 2; }
  auto operator<=>(const FeaturePair&) const = default;
};

/// [m] places of a pair's points; of a segment the last one is not looked at.
using FeaturePoints = std::array<Eigen::Vector3d, 4>;

inline FeaturePoints places(const FeaturePair& pair, std::span<const Eigen::Vector3d> points) {
  FeaturePoints x;
  for (std::size_t i = 0; i < 4; ++i)
    x[i] = pair.points[i] < 0 ? Eigen::Vector3d::Zero() : points[index(pair.points[i])];
  return x;
}

struct FeatureDistance {
  double distance = 0.0;  // [m] never negative
  // The difference of the closest points, from the second side to the first, is
  // sum weights_i x_i: those of the first side add up to 1, those of the second to -1.
  std::array<double, 4> weights{};

  Eigen::Vector3d difference(const FeaturePoints& x) const {
    Eigen::Vector3d sum = weights[0] * x[0] + weights[1] * x[1] + weights[2] * x[2];
    if (weights[3] != 0.0) sum += weights[3] * x[3];
    return sum;
  }
};

/// The distance of a node from a triangle (dim 2: from a segment, with z = 0), or of two edges: the
/// best of the solution inside, where there is one, and those on the ends. So nothing is lost where
/// edges are parallel or features have no extent, and no weight is outside of its feature.
FeatureDistance feature_distance(FeatureKind kind, int dim, const FeaturePoints& x);

}  // namespace abut
