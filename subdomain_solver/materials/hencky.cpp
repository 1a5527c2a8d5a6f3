#include "subdomain_solver/materials/hencky.hpp"

#include "subdomain_solver/materials/log_strain.hpp"

namespace abut {

bool Hencky::evaluate(const Matrix3& f, std::span<const double>, std::span<double>, Need want,
                      PointResponse& out) const {
  FiniteStrain finite;
  LogStrain log;
  if (!FiniteStrain::from(f, finite) || !log.set(finite.finger)) return false;
  const Matrix3 deviatoric = deviator(log.strain());
  Matrix3 kirchhoff = 2.0 * shear() * deviatoric;
  kirchhoff.diagonal().array() += bulk() * finite.log_volume;
  out.energy =
      0.5 * bulk() * finite.log_volume * finite.log_volume + shear() * deviatoric.squaredNorm();
  out.dissipation = 0.0;
  out.stress = kirchhoff * finite.inverse_transpose;
  if (want == Need::tangent)
    out.tangent =
        log.tangent(f, finite.inverse_transpose, kirchhoff, PrincipalModulus::isotropic(moduli()));
  return is_finite(out, want);
}

}  // namespace abut
