#include "subdomain_solver/materials/j2_plasticity.hpp"

#include <cmath>
#include <limits>

#include "base/assert.hpp"
#include "base/error.hpp"
#include "subdomain_solver/materials/log_strain.hpp"

namespace abut {

double Hardening::stress(double a) const {
  const double linear = yield_stress + modulus * a;
  if (!saturation) return linear;
  return linear - (saturation->stress - yield_stress) * std::expm1(-saturation->rate * a);
}

double Hardening::slope(double a) const {
  if (!saturation) return modulus;
  return modulus +
         (saturation->stress - yield_stress) * saturation->rate * std::exp(-saturation->rate * a);
}

double Hardening::stored(double a) const {
  const double linear = 0.5 * modulus * a * a;
  if (!saturation) return linear;
  return linear + (saturation->stress - yield_stress) *
                      (a + std::expm1(-saturation->rate * a) / saturation->rate);
}

namespace {

const char* const no_softening = "softening needs a length that a local law does not have";

const Hardening& checked(const Hardening& h) {
  require_positive(h.yield_stress, "yield_stress", "Pa");
  if (!(h.modulus >= 0.0) || !std::isfinite(h.modulus))
    throw InputError(std::string("must be finite and not negative: ") + no_softening,
                     "hardening_modulus", "Give zero or a positive number");
  if (!h.saturation) return h;
  require_positive(h.saturation->rate, "saturation_rate", "");
  require_positive(h.saturation->stress, "saturation_stress", "Pa");
  if (h.saturation->stress < h.yield_stress)
    throw InputError(std::string("is below yield_stress: ") + no_softening, "saturation_stress",
                     "Give at least yield_stress, or leave the saturation out");
  return h;
}

Matrix3 read_symmetric(std::span<const double> v) {
  Matrix3 m;
  m << v[0], v[3], v[5], v[3], v[1], v[4], v[5], v[4], v[2];
  return m;
}

void write_symmetric(const Matrix3& m, std::span<double> v) {
  v[0] = m(0, 0), v[1] = m(1, 1), v[2] = m(2, 2);
  v[3] = m(0, 1), v[4] = m(1, 2), v[5] = m(2, 0);
}

}  // namespace

/// The return map in principal values of the trial elastic strain.
struct J2Plasticity::Return {
  double a = 0.0;         // equivalent plastic strain at the step's begin
  Eigen::Vector3d trial;  // deviator of the trial elastic strain
  double mises = 0.0;     // [Pa] of the trial Kirchhoff stress
  double p = 0.0;         // increment of a
  double left = 1.0;      // share of the trial deviator that stays elastic
  bool yields = false;
};

J2Plasticity::J2Plasticity(const Moduli& moduli, const Hardening& hardening, double density)
    : IsotropicMaterial(moduli, density), hardening_(checked(hardening)) {}

/// Newton on mises - 3 mu p - s(a + p) = 0, convex and falling in p: from 0 it climbs to the root
/// without overshoot, in one step when hardening is linear.
bool J2Plasticity::return_to_surface(Return& r) const {
  const double stiff = 3.0 * shear();
  r.mises = std::sqrt(6.0) * shear() * r.trial.norm();
  r.yields = r.mises > hardening_.stress(r.a);
  if (!r.yields) return true;
  for (int i = 0; i < 100; ++i) {
    const double excess = r.mises - stiff * r.p - hardening_.stress(r.a + r.p);
    const double step = excess / (stiff + hardening_.slope(r.a + r.p));
    r.p += step;
    // What the roundings of the excess come to as a strain.
    const double rounding =
        4.0 * std::numeric_limits<double>::epsilon() * (r.mises / stiff + r.a + r.p);
    if (std::abs(step) > rounding) continue;
    r.left = 1.0 - stiff * r.p / r.mises;
    return true;
  }
  return false;
}

/// d tau / d trial strain (de Souza Neto et al., 2008, box 7.6).
PrincipalModulus J2Plasticity::modulus(const Return& r) const {
  const double mu = shear();
  PrincipalModulus modulus = PrincipalModulus::isotropic({bulk(), mu * r.left});
  if (!r.yields) return modulus;
  const Eigen::Vector3d n = r.trial / r.trial.norm();
  const double scale = r.p / r.mises - 1.0 / (3.0 * mu + hardening_.slope(r.a + r.p));
  modulus.normal += 6.0 * mu * mu * scale * n * n.transpose();
  return modulus;
}

bool J2Plasticity::evaluate(const Matrix3& f, std::span<const double> before,
                            std::span<double> after, Need want, PointResponse& out) const {
  ABUT_ASSERT(before.size() == 7 && after.size() == 7);
  FiniteStrain finite;
  LogStrain log;
  if (!FiniteStrain::from(f, finite)) return false;
  Matrix3 plastic = read_symmetric(before);  // C_p^-1 - I
  const Matrix3 f_plastic = f * plastic;
  if (!log.set(finite.finger + f_plastic * f.transpose())) return false;

  const double volume = log.principal_strain().sum();  // ln J: plastic flow keeps the volume
  Return r;
  r.a = before[6];
  r.trial = log.principal_strain().array() - volume / 3.0;
  if (!return_to_surface(r)) return false;

  const Eigen::Vector3d elastic = r.left * r.trial;
  const Matrix3 kirchhoff =
      log.with_axes((2.0 * shear() * elastic.array() + bulk() * volume).matrix());
  out.stress = kirchhoff * finite.inverse_transpose;
  out.energy = 0.5 * bulk() * volume * volume + shear() * elastic.squaredNorm() +
               hardening_.stored(r.a + r.p);
  out.dissipation = hardening_.yield_stress * r.p;
  if (want == Need::tangent)
    out.tangent = log.tangent(f + f_plastic, finite.inverse_transpose, kirchhoff, modulus(r));
  if (r.yields) {
    // C_p^-1 changes by F^-1 (b_e - b_e of the trial) F^-T: a difference, so that rounding of the
    // elastic part does not build up in it.
    Eigen::Vector3d change = (2.0 * (r.left - 1.0)) * r.trial;
    for (int i = 0; i < 3; ++i)
      change[i] = (1.0 + log.principal_elastic()[i]) * std::expm1(change[i]);
    const Matrix3& y = finite.inverse_transpose;
    plastic += y.transpose() * log.with_axes(change) * y;
  }
  write_symmetric(plastic, after);
  after[6] = r.a + r.p;
  return is_finite(out, want);
}

}  // namespace abut
