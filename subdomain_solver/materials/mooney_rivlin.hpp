#pragma once

#include "subdomain_solver/materials/isotropic.hpp"
#include "subdomain_solver/materials/mooney_rivlin_numbers.hpp"

namespace abut {

struct MooneyRivlinParameters {
  double c10 = 0.0, c01 = 0.0;  // [Pa] their sum is half the shear modulus and positive
  double bulk_modulus = 0.0;    // [Pa]
  double density = 0.0;         // [kg/m^3]
};

/// Compressible Mooney-Rivlin solid [M.34], I1 and I2 the invariants of C:
/// W = kappa/4 (J^2 - ln J^2 - 1) + c10 (J^(-2/3) I1 - 3) + c01 (J^(-4/3) I2 - 3).
class MooneyRivlin final : public IsotropicMaterial {
 public:
  /// Throws InputError, with the key's name as `where`, when a number is inadmissible.
  explicit MooneyRivlin(const MooneyRivlinParameters& parameters);
  MooneyRivlinNumbers numbers() const { return {c10_, c01_}; }
  [[nodiscard]] bool evaluate(const Matrix3& f, std::span<const double> before,
                              std::span<double> after, Need want,
                              PointResponse& out) const override;

 private:
  double c10_, c01_;
};

}  // namespace abut
