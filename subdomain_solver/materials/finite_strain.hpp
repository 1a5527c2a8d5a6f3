#pragma once

#include "subdomain_solver/materials/material.hpp"

namespace abut {

/// What a finite-strain law reads of F, written in H = F - I so that small strains keep their
/// digits: nothing here is a difference of numbers near 1.
struct FiniteStrain {
  Matrix3 green;               // E = (H + H^T + H^T H)/2
  Matrix3 finger;              // b - I = F F^T - I = H + H^T + H H^T
  Matrix3 inverse_transpose;   // F^-T
  double log_volume = 0.0;     // ln J
  double square_growth = 0.0;  // J^2 - 1

  /// False: det F is not positive, or F is not finite.
  [[nodiscard]] static bool from(const Matrix3& f, FiniteStrain& out);
};

/// E of F, in H as above, for laws that need nothing else of it. False: as of FiniteStrain::from.
[[nodiscard]] bool green_strain(const Matrix3& f, Matrix3& green);

/// Deviator of a symmetric tensor.
inline Matrix3 deviator(const Matrix3& a) { return a - a.trace() / 3.0 * Matrix3::Identity(); }

/// a_iJ b_kL at row i + 3 J, column k + 3 L.
Tangent outer(const Matrix3& a, const Matrix3& b);
/// a_ik b_JL at row i + 3 J, column k + 3 L.
Tangent kronecker(const Matrix3& a, const Matrix3& b);
/// a_iL b_kJ at row i + 3 J, column k + 3 L.
Tangent crossed(const Matrix3& a, const Matrix3& b);

}  // namespace abut
