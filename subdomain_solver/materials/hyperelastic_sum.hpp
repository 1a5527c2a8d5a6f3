#pragma once

#include "subdomain_solver/materials/finite_strain.hpp"

namespace abut {

/// Parts of a compressible hyperelastic law [M.33, M.34]. Each adds its energy, its Kirchhoff
/// stress tau = P F^T and, when wanted, its share of dP/dF.
struct HyperelasticSum {
  double energy = 0.0;
  Matrix3 kirchhoff = Matrix3::Zero();
  Tangent tangent;

  explicit HyperelasticSum(Need want) : wanted(want == Need::tangent) {
    if (wanted) tangent.setZero();
  }
  /// kappa/4 (J^2 - ln J^2 - 1)
  void add_volumetric(double kappa, const FiniteStrain& strain);
  /// c (J^(-2/3) I1 - 3), I1 = tr b
  void add_first_invariant(double c, const Matrix3& f, const FiniteStrain& strain);
  /// c (J^(-4/3) I2 - 3), I2 = ((tr b)^2 - tr b^2)/2
  void add_second_invariant(double c, const Matrix3& f, const FiniteStrain& strain);
  /// The answer; false when a number is not finite.
  [[nodiscard]] bool finish(const FiniteStrain& strain, PointResponse& out) const;

 private:
  bool wanted;
};

}  // namespace abut
