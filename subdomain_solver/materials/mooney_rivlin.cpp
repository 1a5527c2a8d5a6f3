#include "subdomain_solver/materials/mooney_rivlin.hpp"

#include "subdomain_solver/materials/hyperelastic_sum.hpp"

namespace abut {

namespace {

Moduli moduli_at_rest(const MooneyRivlinParameters& p) {
  require_positive(p.c10 + p.c01, "c10 + c01", "Pa");
  return {p.bulk_modulus, 2.0 * (p.c10 + p.c01)};
}

}  // namespace

MooneyRivlin::MooneyRivlin(const MooneyRivlinParameters& parameters)
    : IsotropicMaterial(moduli_at_rest(parameters), parameters.density),
      c10_(parameters.c10),
      c01_(parameters.c01) {}

bool MooneyRivlin::evaluate(const Matrix3& f, std::span<const double>, std::span<double>, Need want,
                            PointResponse& out) const {
  FiniteStrain strain;
  if (!FiniteStrain::from(f, strain)) return false;
  HyperelasticSum sum(want);
  sum.add_volumetric(bulk(), strain);
  sum.add_first_invariant(c10_, f, strain);
  sum.add_second_invariant(c01_, f, strain);
  return sum.finish(strain, out);
}

}  // namespace abut
