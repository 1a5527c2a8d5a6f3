#include "subdomain_solver/fe/layer_inertia.hpp"

namespace abut {

namespace {

/// [kg m^2] about the centre. Masses may differ by direction: a turn moves a node along one axis by
/// its arm along another.
double sum_of_moments(const Mesh& mesh, const Vector& mass) {
  const Eigen::Index dim = mesh.dim, nodes = mass.size() / dim;
  const Eigen::Map<const Eigen::MatrixXd> points(mesh.points.data(), dim, nodes);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < dim; ++i) {
    const Vector along = mass(Eigen::seqN(i, nodes, dim));
    const Vector centre = points * along / along.sum();
    const Eigen::MatrixXd arms = points.colwise() - centre;
    const Vector squares = arms.cwiseAbs2() * along;
    sum += squares.sum() - squares(i);
  }
  return sum;
}

}  // namespace

double inertia_left(const Mesh& mesh, const Vector& whole, const Vector& layered) {
  return sum_of_moments(mesh, layered) / sum_of_moments(mesh, whole);
}

}  // namespace abut
