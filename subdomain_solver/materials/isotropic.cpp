#include "subdomain_solver/materials/isotropic.hpp"

#include <cmath>

namespace abut {

IsotropicMaterial::IsotropicMaterial(const Moduli& moduli, double density)
    : moduli_(moduli), density_(density) {
  require_positive(moduli.bulk, "bulk_modulus", "Pa");
  require_positive(moduli.shear, "shear_modulus", "Pa");
  require_positive(density, "density", "kg/m^3");
  // [m^2/s^2] of waves, the largest that follows
  require_positive(has_derived(moduli) ? moduli.p_wave() / density : HUGE_VAL,
                   "square of the wave speed, which the moduli and the density give,", "m^2/s^2");
}

namespace {

/// x 0 is 0 of finite numbers alone; sums are compiled to few instructions, where allFinite() asks
/// number by number.
template <class Numbers>
bool are_finite(const Numbers& numbers) {
  return (0.0 * numbers).sum() == 0.0;
}

}  // namespace

bool is_finite(const PointResponse& answer, Need want) {
  return std::isfinite(answer.energy) && std::isfinite(answer.dissipation) &&
         are_finite(answer.stress) && (want == Need::stress || are_finite(answer.tangent));
}

}  // namespace abut
