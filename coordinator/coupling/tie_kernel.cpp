#include "coordinator/coupling/tie_kernel.hpp"

namespace abut {

Eigen::VectorXd TieKernel::solve(const Eigen::VectorXd& jump) const {
  const Eigen::Index each = size();
  const int blocks = static_cast<int>(jump.size() / each);
  Eigen::VectorXd force(jump.size());
  for (int m = 0; m < blocks; ++m) {
    Eigen::VectorXd left = jump.segment(m * each, each);
    for (int lag = 1; lag <= m && lag < lags(); ++lag)
      subtract(lag, force.segment((m - lag) * each, each), left);
    force.segment(m * each, each) = invert(left);
  }
  return force;
}

}  // namespace abut
