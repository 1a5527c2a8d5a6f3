#include "subdomain_solver/materials/saint_venant_kirchhoff.hpp"

#include "subdomain_solver/materials/finite_strain.hpp"

namespace abut {

namespace {

/// dP_iJ / dF_kL = delta_ik S_JL + lambda F_iJ F_kL + mu (F_iL F_kJ + delta_JL b_ik), three rows at
/// once: sums of whole tangents would take longer.
void fill_tangent(const Matrix3& f, const Matrix3& s, double lambda, double mu, Tangent& out) {
  const Matrix3 finger = f * f.transpose();
  double* at = out.data();
  for (int l = 0; l < 3; ++l)
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j, at += 3) {
        for (int i = 0; i < 3; ++i) at[i] = lambda * (f(i, j) * f(k, l));
        at[k] += s(j, l);
        const double both = j == l ? 1.0 : 0.0;
        for (int i = 0; i < 3; ++i) at[i] += mu * (f(i, l) * f(k, j) + both * finger(i, k));
      }
}

}  // namespace

bool SaintVenantKirchhoff::evaluate(const Matrix3& f, std::span<const double>, std::span<double>,
                                    Need want, PointResponse& out) const {
  Matrix3 e;
  if (!green_strain(f, e)) return false;
  const double lambda = moduli().lame(), mu = shear();
  const Matrix3 s = lambda * e.trace() * Matrix3::Identity() + 2.0 * mu * e;  // second Piola
  out.stress = f * s;
  out.energy = 0.5 * s.cwiseProduct(e).sum();
  out.dissipation = 0.0;
  if (want == Need::tangent) fill_tangent(f, s, lambda, mu, out.tangent);
  return is_finite(out, want);
}

}  // namespace abut
