#pragma once

#include "subdomain_solver/materials/isotropic.hpp"

namespace abut {

/// Compressible neo-Hookean solid [M.33]:
/// W = kappa/4 (J^2 - ln J^2 - 1) + mu/2 (J^(-2/3) tr C - 3).
class NeoHookean final : public IsotropicMaterial {
 public:
  using IsotropicMaterial::IsotropicMaterial;
  [[nodiscard]] bool evaluate(const Matrix3& f, std::span<const double> before,
                              std::span<double> after, Need want,
                              PointResponse& out) const override;
};

}  // namespace abut
