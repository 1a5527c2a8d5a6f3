#pragma once

#include "subdomain_solver/materials/batched_laws.hpp"
#include "subdomain_solver/materials/lane_log_strain.hpp"

namespace abut {

/// Isotropic elasticity quadratic in the logarithmic strain [M.35] at N points at once: Hencky's
/// law, and the elastic part of J2 plasticity, where a share `left` of the deviator stays.
template <int N>
struct LogElasticLanes {
  using Real = typename Lanes<N>::Real;
  using Bits = typename Lanes<N>::Bits;

  TensorLanes<N> cof;        // cof F
  Real inverse;              // 1/det F
  LogStrainLanes<N> strain;  // elastic
  Real square;               // e : e of its deviator e
  Bits valid;                // where the law has an answer

  /// H = F - I, and the elastic left Cauchy-Green tensor minus I.
  [[gnu::always_inline]] LogElasticLanes(const TensorLanes<N>& h,
                                         const SymmetricLanes<Real>& elastic)
      : strain(elastic) {
    TensorLanes<N> f = h;
    ABUT_UNROLLED (i, 0, 3) f.entry[4 * i] += 1.0;
    const Real volume = cofactor(f, cof);
    inverse = 1.0 / volume;
    valid = strain.valid & (volume > 0.0);
    square = squared_norm(strain.deviator);
  }

  /// P = tau F^-T [Pa]
  [[gnu::always_inline]] void stress(const Moduli& moduli, const Real& left,
                                     TensorLanes<N>& p) const {
    const Real pressure = (moduli.bulk * strain.volume) * inverse;
    const Real scale = (2.0 * moduli.shear) * left * inverse;
    Real t[6];
    ABUT_UNROLLED (k, 0, 6) t[k] = scale * strain.deviator.at[k];
    ABUT_UNROLLED (k, 0, 3) t[k] += pressure;
    ABUT_UNROLLED (j, 0, 3) {
      const Real* c = cof.entry + 3 * j;
      p.entry[3 * j] = fused(t[0], c[0], fused(t[3], c[1], Real(t[5] * c[2])));
      p.entry[3 * j + 1] = fused(t[3], c[0], fused(t[1], c[1], Real(t[4] * c[2])));
      p.entry[3 * j + 2] = fused(t[5], c[0], fused(t[4], c[1], Real(t[2] * c[2])));
    }
  }

  /// [J/m^3], with what else is stored.
  [[gnu::always_inline]] Real energy(const Moduli& moduli, const Real& left,
                                     const Real& stored) const {
    const Real volume = strain.volume * strain.volume, shape = left * left * square;
    return fused(broadcast<Real>(0.5 * moduli.bulk), volume,
                 fused(broadcast<Real>(moduli.shear), shape, stored));
  }
  /// Positive where the law has an answer.
  [[gnu::always_inline]] Real answers() const {
    return valid ? broadcast<Real>(1.0) : broadcast<Real>(-1.0);
  }
};

/// F F^T - I = H^T + H F^T
template <int N>
[[gnu::always_inline]] inline SymmetricLanes<typename Lanes<N>::Real> finger_strain(
    const TensorLanes<N>& h) {
  using Real = typename Lanes<N>::Real;
  constexpr int row[6] = {0, 1, 2, 0, 1, 2}, column[6] = {0, 1, 2, 1, 2, 0};
  SymmetricLanes<Real> e;
  ABUT_UNROLLED (m, 0, 6) {
    const Real *a = h.entry + row[m], *b = h.entry + column[m];
    const Real twice = h.entry[row[m] + 3 * column[m]] + h.entry[column[m] + 3 * row[m]];
    e.at[m] = fused(a[0], b[0], fused(a[3], b[3], fused(a[6], b[6], twice)));
  }
  return e;
}

/// Hencky's law from H = F - I at N points at once: its scalar form to rounding of a modulus.
template <int N>
struct HenckyLanes : LogElasticLanes<N> {
  [[gnu::always_inline]] explicit HenckyLanes(const TensorLanes<N>& h)
      : LogElasticLanes<N>(h, finger_strain(h)) {}
};

}  // namespace abut
