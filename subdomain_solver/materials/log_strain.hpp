#pragma once

#include <Eigen/Core>

#include "subdomain_solver/materials/finite_strain.hpp"

namespace abut {

/// d tau / d strain [Pa] in the principal axes that both share: dtau_aa = sum_b normal_ab
/// dstrain_bb and dtau_ab = 2 shear dstrain_ab.
struct PrincipalModulus {
  Matrix3 normal;
  double shear = 0.0;

  /// kappa and mu alone: that of Hencky.
  static PrincipalModulus isotropic(const Moduli& moduli) {
    Matrix3 normal = Matrix3::Constant(moduli.lame());
    normal.diagonal().array() += 2.0 * moduli.shear;
    return {normal, moduli.shear};
  }
};

/// Logarithmic strain of an elastic left Cauchy-Green tensor b_e = F G F^T with G = (F_p^T F_p)^-1
/// held fixed, by principal values [M.35]. What Hencky and plasticity share.
class LogStrain {
 public:
  /// `elastic`: b_e - I, symmetric. False: b_e is not positive definite.
  [[nodiscard]] bool set(const Matrix3& elastic);

  const Matrix3& strain() const { return strain_; }  // ln(b_e)/2

  /// Symmetric tensor with the axes of b_e and the given principal values.
  Matrix3 with_axes(const Eigen::Vector3d& principal) const {
    return axes_ * principal.asDiagonal() * axes_.transpose();
  }
  /// Principal values of b_e - I, ascending, and of the strain.
  const Eigen::Vector3d& principal_elastic() const { return elastic_; }
  const Eigen::Vector3d& principal_strain() const { return principal_; }

  /// dP/dF for a Kirchhoff stress tau(strain) with dtau/dstrain = modulus; f_g = F G.
  Tangent tangent(const Matrix3& f_g, const Matrix3& inverse_transpose, const Matrix3& kirchhoff,
                  const PrincipalModulus& modulus) const;

 private:
  void set_in_plane(const Matrix3& elastic);

  Matrix3 strain_, axes_;
  Eigen::Vector3d elastic_, principal_;
};

}  // namespace abut
