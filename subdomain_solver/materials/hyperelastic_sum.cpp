#include "subdomain_solver/materials/hyperelastic_sum.hpp"

#include <cmath>

#include "subdomain_solver/materials/isotropic.hpp"

namespace abut {

namespace {

/// d2(J^-p I)/dF2 for an invariant I with gradient g = dI/dF and second derivative dg = dg/dF.
Tangent isochoric_tangent(double power, double scale, double invariant, const Matrix3& g,
                          const Tangent& dg, const Matrix3& inverse_transpose) {
  const Matrix3& y = inverse_transpose;
  return scale * (dg - power * (outer(g, y) + outer(y, g)) +
                  power * power * invariant * outer(y, y) + power * invariant * crossed(y, y));
}

}  // namespace

void HyperelasticSum::add_volumetric(double kappa, const FiniteStrain& strain) {
  const double growth = strain.square_growth;  // J^2 - 1
  energy += 0.25 * kappa * (growth - 2.0 * strain.log_volume);
  kirchhoff.diagonal().array() += 0.5 * kappa * growth;
  if (!wanted) return;
  const Matrix3& y = strain.inverse_transpose;
  tangent += kappa * (1.0 + growth) * outer(y, y) - 0.5 * kappa * growth * crossed(y, y);
}

void HyperelasticSum::add_first_invariant(double c, const Matrix3& f, const FiniteStrain& strain) {
  const double power = 2.0 / 3.0;
  const double less = std::expm1(-power * strain.log_volume);  // J^(-2/3) - 1
  const double growth = strain.finger.trace();                 // I1 - 3
  energy += c * (growth + less * (3.0 + growth));
  kirchhoff += 2.0 * c * (1.0 + less) * deviator(strain.finger);
  if (!wanted) return;
  const Matrix3 identity = Matrix3::Identity();
  tangent += c * isochoric_tangent(power, 1.0 + less, 3.0 + growth, 2.0 * f,
                                   2.0 * kronecker(identity, identity), strain.inverse_transpose);
}

void HyperelasticSum::add_second_invariant(double c, const Matrix3& f, const FiniteStrain& strain) {
  const double power = 4.0 / 3.0;
  const double less = std::expm1(-power * strain.log_volume);  // J^(-4/3) - 1
  const Matrix3& b1 = strain.finger;                           // b - I
  const double t = b1.trace();
  const double growth = 2.0 * t + 0.5 * (t * t - b1.squaredNorm());  // I2 - 3
  energy += c * (growth + less * (3.0 + growth));
  kirchhoff += 2.0 * c * (1.0 + less) * deviator((1.0 + t) * b1 - b1 * b1);  // of I1 b - b^2
  if (!wanted) return;
  const Matrix3 identity = Matrix3::Identity();
  const Matrix3 b = b1 + identity;
  const double i1 = 3.0 + t;
  const Matrix3 g = 2.0 * (i1 * f - b * f);
  const Tangent dg =
      4.0 * outer(f, f) + 2.0 * i1 * kronecker(identity, identity) -
      2.0 * (kronecker(identity, f.transpose() * f) + crossed(f, f) + kronecker(b, identity));
  tangent +=
      c * isochoric_tangent(power, 1.0 + less, 3.0 + growth, g, dg, strain.inverse_transpose);
}

bool HyperelasticSum::finish(const FiniteStrain& strain, PointResponse& out) const {
  out.energy = energy;
  out.dissipation = 0.0;
  out.stress = kirchhoff * strain.inverse_transpose;
  if (wanted) out.tangent = tangent;
  return is_finite(out, wanted ? Need::tangent : Need::stress);
}

}  // namespace abut
