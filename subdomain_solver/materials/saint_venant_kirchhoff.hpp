#pragma once

#include "subdomain_solver/materials/isotropic.hpp"

namespace abut {

/// Linear in the Green strain [M.32]: W = lambda/2 (tr E)^2 + mu E : E. For large rotations and
/// small strains: it softens in compression, and a bar is unstable below a stretch of 1/sqrt(3).
class SaintVenantKirchhoff final : public IsotropicMaterial {
 public:
  using IsotropicMaterial::IsotropicMaterial;
  bool resists_crushing() const override { return false; }
  [[nodiscard]] bool evaluate(const Matrix3& f, std::span<const double> before,
                              std::span<double> after, Need want,
                              PointResponse& out) const override;
};

}  // namespace abut
