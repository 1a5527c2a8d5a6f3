#include "coordinator/coupling/port_turn.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace abut {

Eigen::MatrixXd turn_of(const PortGeometry& port, std::span<const double> displacement) {
  const Eigen::Index dim = port.dim, n = port.count();
  using Points = Eigen::Map<const Eigen::MatrixXd>;
  const Eigen::MatrixXd before = Points(port.points.data(), dim, n);
  const Eigen::MatrixXd after = before + Points(displacement.data(), dim, n);
  const Eigen::MatrixXd spread = (after.colwise() - after.rowwise().mean()) *
                                 (before.colwise() - before.rowwise().mean()).transpose();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(spread, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::MatrixXd mirror = Eigen::MatrixXd::Identity(dim, dim);
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0)
    mirror(dim - 1, dim - 1) = -1.0;
  return svd.matrixU() * mirror * svd.matrixV().transpose();
}

}  // namespace abut
