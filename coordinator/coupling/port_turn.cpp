#include "coordinator/coupling/port_turn.hpp"

#include "base/dense.hpp"

namespace abut {

Eigen::MatrixXd turn_of(const PortGeometry& port, std::span<const double> displacement) {
  const Eigen::Index dim = port.dim, n = port.count();
  using Points = Eigen::Map<const Eigen::MatrixXd>;
  const Eigen::MatrixXd before = Points(port.points.data(), dim, n);
  const Eigen::MatrixXd after = before + Points(displacement.data(), dim, n);
  const Eigen::MatrixXd spread = (after.colwise() - after.rowwise().mean()) *
                                 (before.colwise() - before.rowwise().mean()).transpose();
  const SingularValues svd = singular_values(spread, SingularVectors::both);
  Eigen::MatrixXd mirror = Eigen::MatrixXd::Identity(dim, dim);
  if (determinant_of(svd.u * svd.v.transpose()) < 0.0) mirror(dim - 1, dim - 1) = -1.0;
  return svd.u * mirror * svd.v.transpose();
}

}  // namespace abut
