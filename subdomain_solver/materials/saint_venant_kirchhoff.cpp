#include "subdomain_solver/materials/saint_venant_kirchhoff.hpp"

#include "subdomain_solver/materials/finite_strain.hpp"

namespace abut {

bool SaintVenantKirchhoff::evaluate(const Matrix3& f, std::span<const double>, std::span<double>,
                                    Need want, PointResponse& out) const {
  FiniteStrain strain;
  if (!FiniteStrain::from(f, strain)) return false;
  const Matrix3 identity = Matrix3::Identity();
  const Matrix3& e = strain.green;
  const double lambda = moduli().lame(), mu = shear();
  const Matrix3 s = lambda * e.trace() * identity + 2.0 * mu * e;  // second Piola-Kirchhoff
  out.stress = f * s;
  out.energy = 0.5 * s.cwiseProduct(e).sum();
  out.dissipation = 0.0;
  if (want == Need::tangent)
    out.tangent = kronecker(identity, s) + lambda * outer(f, f) +
                  mu * (crossed(f, f) + kronecker(f * f.transpose(), identity));
  return is_finite(out, want);
}

}  // namespace abut
