#pragma once

#include "subdomain_solver/materials/isotropic.hpp"

namespace abut {

/// Small strain [M.31]: P = C : sym(F - I). Not objective: rotations must be small.
class LinearElastic final : public IsotropicMaterial {
 public:
  using IsotropicMaterial::IsotropicMaterial;
  bool is_linear() const override { return true; }
  [[nodiscard]] bool evaluate(const Matrix3& f, std::span<const double> before,
                              std::span<double> after, Need want,
                              PointResponse& out) const override;
};

}  // namespace abut
