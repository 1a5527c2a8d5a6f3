#pragma once

#include <array>
#include <span>
#include <vector>

#include "coordinator/passive/pressed_points.hpp"

namespace abut {

/// The impulses of all rows of a step, for a linear answer of the bodies: each the smaller of what
/// closes the gap and what does no work, row by row until nothing changes [M.131], [M.132]; then
/// all by one factor where that was not enough to do no work together [M.133].
class RowImpulses {
 public:
  /// The lists must outlive it. `velocities`: mean ones of all points [m/s], of those that stand
  /// the only ones.
  RowImpulses(std::vector<DistanceRow>& rows, PressedPoints& points,
              const TouchingSurfaces& surfaces, std::span<const Eigen::Vector3d> velocities);

  /// Adds to the velocities so much of what the impulses of rows do, from one of them on: those
  /// that are not in the velocities yet.
  void press_from(std::size_t row, double share = 1.0);
  /// Less change of a velocity [m/s] is none, unless impulses do more than that work [J] by it.
  struct Negligible {
    double velocity = 0.0, work = 0.0;
    bool settles = false;  // sweeps have the last word
  };
  void solve(const Negligible& negligible);
  /// [m/s] w of a row along its normal.
  double velocity(const DistanceRow& row) const { return velocity(row, 0); }
  /// [J] sum of J.w
  double work() const;
  /// [J] of it that aimed rows give their bodies.
  double parted() const;
  /// [J] of it that friction of rigid sides had taken too much.
  double returned() const;
  /// Rows that are owed something, press no more and part, give it back from now on, and those that
  /// part by this, too; solved again. `negligible`: as above. Its sum [J].
  double release(const Negligible& negligible);
  /// Makes the work at most so much [J]; the factor that it took.
  double limit(double most);

 private:
  /// Rows that say the same have no unique impulses; this share of a row's own compliance picks
  /// some.
  static constexpr double regularised = 1.0e-6;

  struct Change {         // [1/kg] of a body's velocities by a unit impulse
    Eigen::VectorXd all;  // (values)
    std::vector<std::pair<int, Eigen::Vector3d>> some;  // in its place: first value, of a point
  };
  struct Answer {  // of one row
    std::array<int, 2> body = {-1, -1};
    std::array<std::array<Change, 2>, 3> change;  // (directions; sides)
    double normal = 0.0, tangential = 0.0;        // [1/kg] of its own; the larger one of tangents
  };

  double along(const Eigen::Vector3d& direction, const Eigen::VectorXd& values, int slot) const;
  Answer answer_of(const DistanceRow& row) const;
  void find_changes(const DistanceRow& row, int directions, std::size_t side, Answer& answer,
                    Eigen::Matrix3d& own) const;
  void find_bounds(const DistanceRow& row, int directions, std::size_t side, Answer& answer,
                   Eigen::Matrix3d& own) const;
  /// Calls `see` with the first value and the place of each point of a row that is pressed on a
  /// body.
  template <class See>
  void visit_pressed(const DistanceRow& row, int body, const See& see) const {
    for (std::size_t i = 0; i < 4; ++i) {
      if (!row.counts(i)) continue;
      const std::int32_t point = row.features.points[i];
      const int slot = points_.slot(point);
      if (slot >= 0 && points_.owner(point) == body) see(slot, i);
    }
  }
  double velocity(const DistanceRow& row, int direction) const;
  void press(std::size_t row, int direction, double impulse);
  double solve_normal(std::size_t row);
  double recoil(std::size_t row) const;
  double let_go();
  std::array<double, 2> held(std::size_t row) const;
  std::array<double, 2> given_back(const DistanceRow& row) const;
  double solve_friction(std::size_t row);
  double sweep(double& pressed, double& impulses);

  struct Component {
    std::size_t row;
    int direction;  // 0: along the normal
  };
  double response(const Component& of, const Component& to) const;
  double response_with(const Component& of, const Component& to) const;
  std::vector<Component> pressing() const;
  std::array<double, 2> slid_along(std::size_t row) const;
  void add(const Component& to, double change);
  bool leap();
  void keep();
  void return_to_kept();

  std::vector<DistanceRow>& rows_;
  PressedPoints& points_;
  const TouchingSurfaces& surfaces_;
  std::span<const Eigen::Vector3d> velocities_;
  int dim_;
  std::vector<Answer> answers_;
  std::vector<std::array<double, 3>> kept_;  // [N s] (rows; directions) before a leap
};

/// [m/s] w of a row along its normal (0) or a tangent, of mean velocities of all points.
double row_velocity(const DistanceRow& row, std::span<const Eigen::Vector3d> velocities,
                    int direction);

}  // namespace abut
