#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "surface/feature_distance.hpp"
#include "surface/skin.hpp"

namespace abut {

/// On which side of a surface a place is.
struct SignedSide {
  std::int32_t facet = -1;          // the closest one; -1: none was given
  double gap = 0.0;                 // [m] distance, negative inside of the body
  std::array<double, 4> weights{};  // of the pair of the place and that facet
  Eigen::Vector3d normal;           // unit, out of the body at the closest point
  bool border = false;              // the surface ends there

  bool inside() const { return gap < 0.0; }
};

/// Sides of a skin's surfaces, whose facets look out of their bodies. The sign is that of the
/// normal at the closest point: on an edge the sum of the facets' unit normals, on a node that sum
/// by their angles there, which is right whatever the corner's shape (Baerentzen and Aanaes 2005).
/// The skin must live; queries allocate nothing.
class SkinSides {
 public:
  explicit SkinSides(const Skin& skin);

  /// Unit normal of a facet; zero without an area.
  Eigen::Vector3d facet_normal(std::span<const Eigen::Vector3d> points, std::int32_t facet) const;
  /// Unit normal at a point, of its facets by their angles there; zero where there is none.
  Eigen::Vector3d point_normal(std::span<const Eigen::Vector3d> points, std::int32_t point) const;
  /// Unit normal of an edge, of its facets; zero where there is none.
  Eigen::Vector3d edge_normal(std::span<const Eigen::Vector3d> points, std::int32_t one,
                              std::int32_t other) const;
  /// Smallest cosine of the angles between the normals of an edge's facets and its own: 1 where it
  /// lies in a flat face.
  double fold(std::span<const Eigen::Vector3d> points, std::int32_t one, std::int32_t other) const;
  /// The side of the closest of the given facets. Where the surface ends, inside is what is behind
  /// the normal rather than beside it.
  SignedSide side(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& x,
                  std::span<const std::int32_t> facets) const;

 private:
  struct Place {  // a feature, by the points of it that have a share
    int count = 0;
    std::array<std::int32_t, 3> points{-1, -1, -1};
  };
  Place place(std::int32_t facet, const std::array<double, 3>& shares) const;
  std::span<const std::int32_t> around(std::int32_t point) const;
  bool has(std::int32_t facet, std::int32_t point) const;
  bool ends_at(const Place& place) const;
  Eigen::Vector3d normal_at(std::span<const Eigen::Vector3d> points, const Place& place) const;
  template <class Visit>
  void visit_facets(const Place& place, const Visit& visit) const;
  double angle(std::span<const Eigen::Vector3d> points, std::int32_t facet,
               std::int32_t point) const;

  const Skin& skin_;
  std::vector<std::int32_t> offsets_, facets_;  // of each point, ascending
};

}  // namespace abut
