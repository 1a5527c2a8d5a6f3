#include "subdomain_solver/materials/log_strain.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

namespace abut {

namespace {

/// (f(x) - f(y))/(x - y) of f = log1p(.)/2, and f' where x = y: log1p(z)/z loses no digits as
/// z -> 0, so equal and nearly equal values need no threshold.
double divided_difference(double x, double y) {
  const double z = (x - y) / (1.0 + y);
  return 0.5 * (z == 0.0 ? 1.0 : std::log1p(z) / z) / (1.0 + y);
}

}  // namespace

bool LogStrain::set(const Matrix3& elastic) {
  // The iterative solver: the direct one loses half the digits when eigenvalues nearly coincide.
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(elastic);
  if (solver.info() != Eigen::Success) return false;
  axes_ = solver.eigenvectors();
  elastic_ = solver.eigenvalues();
  if (!(elastic_.minCoeff() > -1.0) || !elastic_.allFinite()) return false;
  for (int a = 0; a < 3; ++a) principal_[a] = 0.5 * std::log1p(elastic_[a]);
  strain_ = with_axes(principal_);
  return true;
}

Tangent LogStrain::derivative() const {
  Eigen::Matrix<double, 9, 1> differences;
  for (int b = 0; b < 3; ++b)
    for (int a = 0; a < 3; ++a)
      differences[a + 3 * b] = divided_difference(elastic_[a], elastic_[b]);
  const Tangent rotation = kronecker(axes_, axes_);
  return rotation * differences.asDiagonal() * rotation.transpose();
}

Tangent LogStrain::tangent(const Matrix3& f_g, const Matrix3& inverse_transpose,
                           const Matrix3& kirchhoff, const Tangent& modulus) const {
  const Matrix3 identity = Matrix3::Identity();
  // db_pq/dF_kL = delta_pk (F G)_qL + (F G)_pL delta_qk
  const Tangent growth = kronecker(identity, f_g) + crossed(f_g, identity);
  const Tangent spatial = modulus * derivative() * growth;  // dtau/dF
  return kronecker(identity, inverse_transpose.transpose()) * spatial -
         crossed(kirchhoff * inverse_transpose, inverse_transpose);
}

Tangent isotropic_modulus(const Moduli& moduli) {
  const Matrix3 identity = Matrix3::Identity();
  return moduli.lame() * outer(identity, identity) +
         moduli.shear * (kronecker(identity, identity) + crossed(identity, identity));
}

}  // namespace abut
