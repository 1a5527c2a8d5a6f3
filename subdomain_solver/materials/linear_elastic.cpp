#include "subdomain_solver/materials/linear_elastic.hpp"

#include "subdomain_solver/materials/finite_strain.hpp"

namespace abut {

bool LinearElastic::evaluate(const Matrix3& f, std::span<const double>, std::span<double>,
                             Need want, PointResponse& out) const {
  const Matrix3 identity = Matrix3::Identity();
  const Matrix3 h = f - identity;
  const Matrix3 strain = 0.5 * (h + h.transpose());
  const double lambda = moduli().lame(), mu = shear();
  out.stress = lambda * strain.trace() * identity + 2.0 * mu * strain;
  out.energy = 0.5 * out.stress.cwiseProduct(strain).sum();
  out.dissipation = 0.0;
  if (want == Need::tangent)
    out.tangent = lambda * outer(identity, identity) +
                  mu * (kronecker(identity, identity) + crossed(identity, identity));
  return is_finite(out, want);
}

}  // namespace abut
