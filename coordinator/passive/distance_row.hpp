#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "base/index.hpp"
#include "surface/feature_distance.hpp"

namespace abut {

/// What keeps two features of surfaces apart in a step [M.131]: their difference vector along a
/// fixed normal, sum of weights x places, and the impulse [N s] that acts along it. The first
/// feature's weights are positive and sum to 1, the other one's negative.
struct DistanceRow {
  FeaturePair features;
  std::array<double, 4> weights{};
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  std::array<Eigen::Vector3d, 2> tangents{Eigen::Vector3d::Zero(),
                                          Eigen::Vector3d::Zero()};  // in the plane one
  double gap = 0.0;  // [m] along the normal at the step's begin
  double friction = 0.0;
  bool behind = false;  // its node begins behind the other surface
  /// (tangents; points) Beside the weights, what a unit impulse along a tangent puts on the points,
  /// so that its two sides have no moment together however far apart they are [M.151].
  std::array<Eigen::Matrix<double, 3, 4>, 2> couples{Eigen::Matrix<double, 3, 4>::Zero(),
                                                     Eigen::Matrix<double, 3, 4>::Zero()};
  bool coupled = false;  // some are not zero, of points whose weights may be

  double closing = 0.0;  // [m/s] c: the row's velocity w must be at least -c
  double push = 0.0;     // [m/s] of it, that parts what is too near
  double owed = 0.0;     // [J] that its normal impulses took and that it gives back as it parts
  bool recoils = false;  // it does so in this step, at w = push
  // Of rigid sides in an impact [M.161]: it has this mean velocity after the step, by an impulse of
  // at least -pushed, so that they part with so much.
  bool aimed = false;
  double aim = 0.0, approach = 0.0, parting = 0.0;  // [m/s]
  double pushed = 0.0;                              // [N s]
  std::array<double, 2> rubbed{};  // [N s] along the tangents, by friction with that
  double heat = 0.0;               // [J] that it took
  double normal_impulse = 0.0;
  std::array<double, 2> tangential_impulse{};

  /// The first point of either feature.
  std::int32_t first_point(int side) const {
    return features.points[side == 0 ? 0 : index(features.first_side())];
  }
  /// [m/s] what w is to be at least.
  double least() const { return recoils ? push : held(); }
  /// [m/s] the same of a row that gives nothing back.
  double held() const { return aimed ? std::max(aim, -closing) : -closing; }
  Eigen::Vector3d impulse() const {
    return normal_impulse * normal + tangential_impulse[0] * tangents[0] +
           tangential_impulse[1] * tangents[1];
  }
  /// [N s] on one of the points.
  Eigen::Vector3d impulse_on(std::size_t i) const {
    const Eigen::Vector3d along = weights[i] * impulse();
    if (!coupled) return along;
    return along + tangential_impulse[0] * column(0, i) + tangential_impulse[1] * column(1, i);
  }
  /// Of a unit impulse: 0 along the normal, 1 and 2 along tangents.
  Eigen::Vector3d share_on(std::size_t i, int direction) const {
    if (direction == 0) return weights[i] * normal;
    const std::size_t t = index(direction - 1);
    const Eigen::Vector3d along = weights[i] * tangents[t];
    return coupled ? Eigen::Vector3d(along + column(t, i)) : along;
  }
  /// Whether it presses on a point.
  bool counts(std::size_t i) const {
    return weights[i] != 0.0 ||
           (coupled && !(column(0, i).isZero(0.0) && column(1, i).isZero(0.0)));
  }
  Eigen::Vector3d column(std::size_t tangent, std::size_t i) const {
    return couples[tangent].col(static_cast<Eigen::Index>(i));
  }
  /// Makes tangents of the normal; in the plane the first one alone.
  void find_tangents(int dim);
  /// Makes couples of the tangents and of where the points are.
  void find_couples(int dim, const FeaturePoints& places);
  /// What tells it from other rows, from step to step: its kind and the points that count.
  using Key = std::array<std::int32_t, 5>;
  Key key() const;
};

}  // namespace abut
