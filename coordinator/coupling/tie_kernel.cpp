#include "coordinator/coupling/tie_kernel.hpp"

namespace abut {

Eigen::VectorXd TieKernel::solve(const Eigen::VectorXd& jump) const { return march(jump, nullptr); }

Eigen::VectorXd TieKernel::unanswered(const Eigen::VectorXd& jump) const {
  Eigen::VectorXd rest;
  if (!redundant()) return rest;
  rest.resize(jump.size());
  march(jump, &rest);
  return rest;
}

/// Forward in time.
Eigen::VectorXd TieKernel::march(const Eigen::VectorXd& jump, Eigen::VectorXd* rest) const {
  const Eigen::Index each = size();
  const int blocks = static_cast<int>(jump.size() / each);
  Eigen::VectorXd force(jump.size());
  for (int m = 0; m < blocks; ++m) {
    Eigen::VectorXd left = jump.segment(m * each, each);
    for (int lag = 1; lag <= m && lag < lags(); ++lag)
      subtract(lag, force.segment((m - lag) * each, each), left);
    force.segment(m * each, each) = invert(left);
    if (rest == nullptr) continue;
    subtract(0, force.segment(m * each, each), left);
    rest->segment(m * each, each) = left;
  }
  return force;
}

}  // namespace abut
