#include "subdomain_solver/fe/hourglass.hpp"

#include "base/assert.hpp"

namespace abut {

bool has_hourglasses(const Element& element) {
  return element.name == "hex8" || element.name == "quad4";
}

Eigen::MatrixXd hourglass_stiffness(const Element& element, const Eigen::MatrixXd& x,
                                    const Eigen::MatrixXd& b, double volume, double stiffness) {
  ABUT_ASSERT(has_hourglasses(element));
  const int dim = element.dim, n = element.nodes;
  // Products of the corners' coordinates: yz, zx, xy, xyz of a cube, xy of a square.
  Eigen::MatrixXd gamma(n, dim == 3 ? 4 : 1);
  for (int a = 0; a < n; ++a) {
    const double* c = element.corners.data() + a * dim;
    if (dim == 3)
      gamma.row(a) << c[1] * c[2], c[2] * c[0], c[0] * c[1], c[0] * c[1] * c[2];
    else
      gamma(a, 0) = c[0] * c[1];
  }
  gamma -= b * (x.transpose() * gamma);  // no part of a linear field
  const double k = stiffness / (n * dim) * volume * b.squaredNorm();
  return k * gamma * gamma.transpose();
}

}  // namespace abut
