#pragma once

#include <vector>

#include "subdomain_solver/model.hpp"

namespace abut {

/// What holds rigid motions of a body without inertia that nothing but contact holds: springs that
/// begin every step where the body is, so that their force vanishes as the body settles  [M.143]
///
///   r(q) - f + C m = 0,   m = s (C^T q - a),   C = R / n
///
/// a: C^T q at the step's begin. What they bore is kept in the motion, so that it can be told.
class Stabilisation {
 public:
  /// `motions`: R (n, k) of the free coordinates, columns of length sqrt(n) at right angles;
  /// `stiffness`: s [N/m]; `at_most`: of all that presses on the body, that it may bear at the end.
  Stabilisation(Eigen::MatrixXd motions, double stiffness, double at_most)
      : motions_(std::move(motions)),
        stiffness_(stiffness),
        at_most_(at_most),
        stiffer_(Eigen::MatrixXd::Zero(motions_.cols(), motions_.cols())) {}

  double at_most() const { return at_most_; }

  /// A step begins at x [m] (n).
  void begin(const Vector& x) {
    anchor_ = place_of(x);
    stiffer_.setZero();
  }
  /// Holds a motion along which the body falls, R w with w (k) of length 1, by so much more [N/m]
  /// until the step ends.
  void stiffen(const Vector& along, double stiffness) {
    stiffer_ += stiffness * along * along.transpose();
  }
  /// [N/m] with which it holds that motion now.
  double stiffness(const Vector& along) const {
    return along.size() > 0 ? stiffness_ + along.dot(stiffer_ * along) : stiffness_;
  }
  /// Adds C m to a balance (n), at x.
  void add_force(const Vector& x, Vector& balance) const;
  /// A step ends at x, where these forces [N] (n) act on the body: puts down what was borne, and
  /// the work that it took.
  void settle(const Vector& x, const Vector& loads, Motion& motion) const;
  /// The same of a step in which something else held the body: with these forces [N] (n), along
  /// which it went so far [m] (n).
  void tell(const Vector& force, const Vector& gone, const Vector& loads, Motion& motion) const;

  /// What a motion remembers.
  struct Told {
    double force = 0.0;       // [N] at the end of the last step, summed over all coordinates
    double share = 0.0;       // of all that presses on the body then
    double share_most = 0.0;  // at the end of any step
    double along = 0.0;  // then, of what acts along the motion that it held, or of 1/1000 of all
    double work = 0.0;   // [J] since the run began
  };
  static Told told(const Motion& motion);
  /// [N] (n) with which it held the body at the end of the last step.
  Vector held(const Motion& motion) const;

 private:
  void tell(const Vector& m, double done, const Vector& loads, Motion& motion) const;
  double share_along(const Vector& m, const Vector& loads, double all) const;
  Vector hold(const Vector& gone) const { return stiffness_ * gone + stiffer_ * gone; }
  Vector place_of(const Vector& x) const {
    return motions_.transpose() * x / static_cast<double>(x.size());
  }
  Vector spread(const Vector& along) const {
    return motions_ * along / static_cast<double>(motions_.rows());
  }

  Eigen::MatrixXd motions_;
  double stiffness_, at_most_;
  Vector anchor_;            // [m] (k)
  Eigen::MatrixXd stiffer_;  // [N/m] (k, k) in this step
};

}  // namespace abut
