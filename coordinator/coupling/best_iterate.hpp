#pragma once

#include <Eigen/Dense>

namespace abut {

/// The best iterate of a window so far. Secants of other points in contact lead away from the
/// answer, and plain steps never do for long: then the iteration goes on from there.
class BestIterate {
 public:
  /// After a sweep, `miss` by any measure: whether it and the sweeps before it, `patience` of them,
  /// are worse than the best.
  bool left(const Eigen::VectorXd& x, const Eigen::VectorXd& g, double miss, int patience) {
    if (worse_ < 0 || miss < miss_) {
      x_ = x;
      g_ = g;
      miss_ = miss;
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
  Eigen::VectorXd x_, g_;
  double miss_ = 0.0;
  int worse_ = -1;  // sweeps since; below 0: any is taken for the best
};

}  // namespace abut
