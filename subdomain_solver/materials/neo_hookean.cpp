#include "subdomain_solver/materials/neo_hookean.hpp"

#include "subdomain_solver/materials/hyperelastic_sum.hpp"

namespace abut {

bool NeoHookean::evaluate(const Matrix3& f, std::span<const double>, std::span<double>, Need want,
                          PointResponse& out) const {
  FiniteStrain strain;
  if (!FiniteStrain::from(f, strain)) return false;
  HyperelasticSum sum(want);
  sum.add_volumetric(bulk(), strain);
  sum.add_first_invariant(0.5 * shear(), f, strain);
  return sum.finish(strain, out);
}

}  // namespace abut
