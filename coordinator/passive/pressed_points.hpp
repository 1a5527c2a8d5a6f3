#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "contract/passive.hpp"
#include "coordinator/passive/distance_row.hpp"
#include "coordinator/passive/touching_surfaces.hpp"

namespace abut {

/// The points that rows press on, by body, and how they answer: around the impulses that were
/// tried, w = w_tried + C (J - J_tried) [M.129]. Bodies that are tied answer together, as the first
/// of them: `owners` (bodies) says who that is.
class PressedPoints {
 public:
  PressedPoints(const TouchingSurfaces& surfaces, std::vector<int> owners)
      : surfaces_(surfaces), owners_(std::move(owners)), bodies_(owners_.size()) {}

  int owner(std::int32_t point) const { return owners_[index(surfaces_[point].body)]; }

  void clear();
  /// Takes the points of a row; true: some are new, and the bodies have not told of them: number()
  /// is to be called once after all rows.
  bool add(const DistanceRow& row);
  /// The places of all points among the values of their bodies: of n points by n log n comparisons.
  void number();
  /// Whether anything is pressed on an owner that could move it.
  bool any(int owner) const { return !bodies_[index(owner)].slots.empty(); }
  /// The points of a body's ports, for PassiveStep::pressed.
  std::vector<std::vector<std::int32_t>> list(int body, std::size_t ports) const;
  /// Takes the compliance that a body told, times `softer`, and the mean velocities [m/s] (points)
  /// under the impulses that were tried.
  void take(int owner, const Eigen::Ref<const Eigen::MatrixXd>& compliance, double softer,
            std::span<const Eigen::Vector3d> velocities);
  /// The same of what a body replied, which may be the diagonal of a bound.
  void take(int owner, const PassiveReply& reply, double softer,
            std::span<const Eigen::Vector3d> velocities);
  /// Body, port and point of an owner's values.
  std::vector<std::array<std::int32_t, 3>> values(int owner) const;

  /// First value of a point among those of its body; -1: it is not pressed, or stands.
  int slot(std::int32_t point) const { return slots_.empty() ? -1 : slots_[point]; }
  Eigen::VectorXd& velocity(int body) { return bodies_[index(body)].velocity; }
  const Eigen::VectorXd& velocity(int body) const { return bodies_[index(body)].velocity; }
  /// Without entries where bound() has some.
  const Eigen::MatrixXd& compliance(int body) const { return bodies_[index(body)].compliance; }
  const Eigen::VectorXd& bound(int body) const { return bodies_[index(body)].bound; }
  /// [1/kg] of a point itself, at most along one axis; nothing: its body has not told of it.
  std::optional<double> of_its_own(std::int32_t point) const;

 private:
  struct Body {
    std::vector<std::int32_t> slots;  // points of the skin, in the order of values
    Eigen::MatrixXd compliance;       // [1/kg] (values, values)
    Eigen::VectorXd bound;            // [1/kg] (values), in its place
    Eigen::VectorXd velocity;         // [m/s] (values)
  };

  const TouchingSurfaces& surfaces_;
  std::vector<int> owners_;
  void take_velocities(Body& to, std::span<const Eigen::Vector3d> velocities) const;

  std::vector<Body> bodies_;  // by owner
  std::vector<int> slots_;    // by point
};

}  // namespace abut
