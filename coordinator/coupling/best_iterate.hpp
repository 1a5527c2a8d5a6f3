#pragma once

#include <Eigen/Dense>

namespace abut {

/// The best iterate of a window so far. Secants of other points in contact lead away from where
/// ties and contact agree, and plain steps beside contact never do for long: then the iteration
/// goes on from there.
class BestIterate {
 public:
  /// After a sweep: whether it, and those before it, have left the best one too far behind.
  bool left(const Eigen::VectorXd& x, const Eigen::VectorXd& g, double mismatch) {
    if (worse_ < 0 || mismatch < mismatch_) {
      x_ = x;
      g_ = g;
      mismatch_ = mismatch;
      worse_ = 0;
      return false;
    }
    if (++worse_ < patience) return false;
    worse_ = -1;  // whatever the plain step leads to is where it goes on
    return true;
  }
  const Eigen::VectorXd& iterate() const { return x_; }
  const Eigen::VectorXd& image() const { return g_; }

 private:
  static constexpr int patience = 3;  // sweeps
  Eigen::VectorXd x_, g_;
  double mismatch_ = 0.0;
  int worse_ = -1;  // sweeps since; below 0: any is taken for the best
};

}  // namespace abut
