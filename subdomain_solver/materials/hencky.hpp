#pragma once

#include "subdomain_solver/materials/isotropic.hpp"

namespace abut {

/// Quadratic in the logarithmic strain [M.35]: W = kappa/2 (ln J)^2 + mu dev e : dev e,
/// e = ln(F F^T)/2. The elastic part of J2Plasticity.
class Hencky final : public IsotropicMaterial {
 public:
  using IsotropicMaterial::IsotropicMaterial;
  [[nodiscard]] bool evaluate(const Matrix3& f, std::span<const double> before,
                              std::span<double> after, Need want,
                              PointResponse& out) const override;
};

}  // namespace abut
