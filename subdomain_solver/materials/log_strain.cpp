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

Tangent LogStrain::tangent(const Matrix3& f_g, const Matrix3& inverse_transpose,
                           const Matrix3& kirchhoff, const PrincipalModulus& modulus) const {
  Matrix3 differences;
  for (int b = 0; b < 3; ++b)
    for (int a = 0; a < 3; ++a) differences(a, b) = divided_difference(elastic_[a], elastic_[b]);
  // Everything in principal axes, one column of the tangent after the other.
  const Matrix3 f_g_axes = axes_.transpose() * f_g;
  const Matrix3 inverse_axes = axes_.transpose() * inverse_transpose;
  const Matrix3 stress = kirchhoff * inverse_transpose;  // P
  Tangent result;
  for (int l = 0; l < 3; ++l)
    for (int k = 0; k < 3; ++k) {
      // db_pq/dF_kL = delta_pk (F G)_qL + (F G)_pL delta_qk
      const Matrix3 half = axes_.row(k).transpose() * f_g_axes.col(l).transpose();
      const Matrix3 strain = differences.cwiseProduct(half + half.transpose());
      Matrix3 change = 2.0 * modulus.shear * strain;
      change.diagonal() = modulus.normal * strain.diagonal();
      const Matrix3 turned = axes_ * change;
      // dF^-T_mJ/dF_kL = -F^-T_mL F^-T_kJ
      result.col(k + 3 * l).reshaped(3, 3) =
          turned * inverse_axes - stress.col(l) * inverse_transpose.row(k);
    }
  return result;
}

}  // namespace abut
