#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "contract/passive.hpp"
#include "coordinator/coupling/bodies.hpp"
#include "surface/skin.hpp"
#include "surface/skin_trees.hpp"

namespace abut {

/// Two surfaces that may touch, Coulomb's coefficient between them, the part of their speed with
/// which they part where neither deforms, and the coefficient of what sticks, if that is larger.
struct TouchingPair {
  std::array<Side, 2> sides;
  double friction = 0.0, restitution = 0.0, holding = 0.0;
};

/// All surfaces of a run that may touch, as one skin: points of all ports, one group per port.
class TouchingSurfaces {
 public:
  struct Point {
    int body = 0, port = 0;
    std::int32_t point = 0;  // of the port
  };

  /// The bodies must outlive it.
  TouchingSurfaces(std::span<const TouchingPair> pairs, const Bodies& bodies);

  const Skin& skin() const { return skin_; }
  std::size_t count() const { return points_.size(); }
  const Point& operator[](std::int32_t point) const { return points_[point]; }
  /// Adds what a step moved its points by [m] to where they were.
  void move(std::span<const PassiveReply> replies, std::span<const Eigen::Vector3d> from,
            std::vector<Eigen::Vector3d>& to) const;
  /// [m] the places of all points at the end of their bodies' latest responses.
  void place(std::span<const Response> responses, std::vector<Eigen::Vector3d>& places) const;
  /// [m] the same at an instant of their traces, which bodies have in common.
  void place(std::span<const Response> responses, std::size_t instant,
             std::vector<Eigen::Vector3d>& places) const;
  /// [m] the same at a part of the latest window, 0 to 1: linear between instants of the traces.
  void place_within(std::span<const Response> responses, double part,
                    std::vector<Eigen::Vector3d>& places) const;
  /// [m] the longest way from its begin that a point has been in the latest window.
  double longest_way(std::span<const Response> responses) const;
  const std::vector<Eigen::Vector3d>& reference() const { return reference_; }
  /// Pairs of features that may touch.
  FeatureChoice choice() const;
  /// Whether two groups may touch.
  bool touch(int one, int other) const { return friction_of(one, other) >= 0.0; }
  /// Coulomb's coefficient between the groups of two points.
  double friction(std::int32_t one, std::int32_t other) const {
    return friction_of(skin_.group[one], skin_.group[other]);
  }
  /// The same of what sticks: as large, or larger.
  double holding(std::int32_t one, std::int32_t other) const {
    return std::max(
        friction(one, other),
        pair_static_[index(skin_.group[one]) * ports_.size() + index(skin_.group[other])]);
  }
  /// Of two rigid ones.
  double restitution(std::int32_t one, std::int32_t other) const {
    return pair_restitution_[index(skin_.group[one]) * ports_.size() + index(skin_.group[other])];
  }
  /// Whether nothing that presses on a point moves it.
  bool stands(std::int32_t point) const { return stands_[point] != 0; }
  /// Along x, +1 or -1: of a skin of one dimension.
  double outward(std::int32_t point) const {
    return bodies_.port(ports_[index(skin_.group[index(point)])]).geometry.normals.front();
  }
  int groups() const { return static_cast<int>(ports_.size()); }
  const Side& port(int group) const { return ports_[group]; }
  /// [m] the shortest edge of surfaces that deform, of bars the shortest element at an end; of all
  /// where none does.
  double shortest_edge() const { return shortest_edge_; }

 private:
  double friction_of(int one, int other) const {
    return pair_friction_[index(one) * ports_.size() + index(other)];
  }
  int group_of(const Side& side, const Bodies& bodies);
  void find_shortest_edge(const Bodies& bodies);

  const Bodies& bodies_;
  int dim_ = 3;
  Skin skin_;
  std::vector<Point> points_;
  std::vector<Side> ports_;            // by group
  std::vector<double> pair_friction_;  // (groups, groups); negative: they may not touch
  std::vector<double> pair_static_, pair_restitution_;  // (groups, groups)
  std::vector<std::uint8_t> stands_;                    // (points)
  std::vector<Eigen::Vector3d> reference_;              // [m]
  double shortest_edge_ = 0.0;
};

}  // namespace abut
