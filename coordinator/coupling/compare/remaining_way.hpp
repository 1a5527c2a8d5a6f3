#pragma once

#include <deque>

#include <Eigen/Dense>

namespace abut {

/// How far the iterates y of a map that contracts slowly still are from its fixed point, whatever
/// accelerates them [M.124]: by how residuals r = g(y) - y changed with the latest iterates. Where
/// they fall by a rate, of plain iterations, that is r / (1 - rate).
class RemainingWay {
 public:
  void begin() { past_.clear(); }
  void see(const Eigen::VectorXd& y, const Eigen::VectorXd& r);
  /// In the unit of iterates, by the largest component; nothing is known before three: then much
  /// more than the last residual.
  double left() const { return left_; }

 private:
  struct Sweep {
    Eigen::VectorXd y, r;
  };
  std::deque<Sweep> past_;  // the latest first
  double left_ = 0.0;
};

}  // namespace abut
