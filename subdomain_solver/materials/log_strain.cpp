#include "subdomain_solver/materials/log_strain.hpp"

#include <cmath>
#include <utility>

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

/// Of bodies in the plane and round an axis, whose third axis is a principal one: one turn of
/// Jacobi's method, which loses no digits when eigenvalues nearly coincide.
void LogStrain::set_in_plane(const Matrix3& elastic) {
  const double off = elastic(0, 1), apart = 0.5 * (elastic(1, 1) - elastic(0, 0));
  const double size = std::abs(apart) + std::sqrt(apart * apart + off * off);
  const double tangent = size == 0.0 ? 0.0 : std::copysign(off, off * apart) / size;
  const double cosine = 1.0 / std::sqrt(1.0 + tangent * tangent), sine = tangent * cosine;
  elastic_ = {elastic(0, 0) - tangent * off, elastic(1, 1) + tangent * off, elastic(2, 2)};
  axes_ << cosine, sine, 0.0, -sine, cosine, 0.0, 0.0, 0.0, 1.0;
  const auto order = [this](Eigen::Index a, Eigen::Index b) {
    if (elastic_[a] <= elastic_[b]) return;
    std::swap(elastic_[a], elastic_[b]);
    axes_.col(a).swap(axes_.col(b));
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
}

bool LogStrain::set(const Matrix3& elastic) {
  if (elastic(0, 2) == 0.0 && elastic(1, 2) == 0.0) {
    set_in_plane(elastic);
  } else {
    // The iterative solver: the direct one loses half the digits when eigenvalues nearly coincide.
    const Eigen::SelfAdjointEigenSolver<Matrix3> solver(elastic);
    if (solver.info() != Eigen::Success) return false;
    axes_ = solver.eigenvectors();
    elastic_ = solver.eigenvalues();
  }
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
