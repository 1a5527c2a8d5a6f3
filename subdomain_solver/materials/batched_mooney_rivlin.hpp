#pragma once

#include "subdomain_solver/materials/batched_tangents.hpp"
#include "subdomain_solver/materials/lane_logarithm.hpp"
#include "subdomain_solver/materials/mooney_rivlin_numbers.hpp"

namespace abut {

/// F, cof F and invariants of C at N points from H = F - I. What is small where strains are is no
/// difference: cof F - I = tr(H) I - H^T + cof H, and I2 = |cof F|^2.
template <int N>
struct InvariantLanes {
  using Real = typename Lanes<N>::Real;
  TensorLanes<N> f, cof;  // F, cof F
  Real first, second;     // I1 - 3, I2 - 3
  Real growth, jacobian;  // J - 1, J

  [[gnu::always_inline]] explicit InvariantLanes(const TensorLanes<N>& h) : f(h) {
    TensorLanes<N> minors;
    const Real determinant = cofactor(h, minors);
    const Real trace = h.entry[0] + h.entry[4] + h.entry[8];
    const Real areas = minors.entry[0] + minors.entry[4] + minors.entry[8];
    growth = trace + areas + determinant;
    jacobian = 1.0 + growth;
    ABUT_UNROLLED (j, 0, 3)
      ABUT_UNROLLED (i, 0, 3) {
        cof.entry[i + 3 * j] = minors.entry[i + 3 * j] - h.entry[j + 3 * i];
        if (i == j) cof.entry[i + 3 * j] += trace;
      }
    first = fused(broadcast<Real>(2.0), trace, squared_norm(h));
    second = fused(broadcast<Real>(2.0), Real(2.0 * trace + areas), squared_norm(cof));
    ABUT_UNROLLED (i, 0, 3) {
      f.entry[4 * i] += 1.0;
      cof.entry[4 * i] += 1.0;
    }
  }

  /// Half of dI2/dF: both factors of |cof F|^2/2 are products of entries of F.
  [[gnu::always_inline]] Real slope_of_second(int i, int j) const {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = 3 * ((j + 1) % 3), j2 = 3 * ((j + 2) % 3);
    const Real *a = cof.entry, *b = f.entry;
    const Real off = fused(a[i1 + j2], b[i2 + j1], Real(a[i2 + j1] * b[i1 + j2]));
    return fused(a[i1 + j1], b[i2 + j2], fused(a[i2 + j2], b[i1 + j1], Real(-off)));
  }
};

/// Mooney and Rivlin's law [M.34] from H at N points at once: P [Pa] and W [J/m^3], its scalar form
/// to rounding of a modulus. `valid`: as in batched_laws.hpp.
struct BatchedMooneyRivlin {
  Moduli moduli;
  MooneyRivlinNumbers numbers;

  template <int N>
  [[gnu::always_inline]] void respond(const TensorLanes<N>& h, TensorLanes<N>& p,
                                      typename Lanes<N>::Real& energy,
                                      typename Lanes<N>::Real& valid) const {
    using Real = typename Lanes<N>::Real;
    const InvariantLanes<N> at(h);
    const Real growth = fused(at.growth, at.growth, Real(2.0 * at.growth));  // J^2 - 1
    const Real less = inverse_cube_root_less_one<N>(growth);                 // J^(-2/3) - 1
    const Real less_twice = fused(less, less, Real(2.0 * less));             // J^(-4/3) - 1
    const Real part = 1.0 + less, square = part * part;
    const Real a = (2.0 * numbers.c10) * part, b = (2.0 * numbers.c01) * square;
    const Real stretched = fused(a, Real(3.0 + at.first), Real((2.0 * b) * (3.0 + at.second)));
    const Real pressure =
        fused(broadcast<Real>(0.5 * moduli.bulk), growth, Real((-1.0 / 3.0) * stretched));
    const Real c = pressure * (at.jacobian * part) * square;  // over J
    ABUT_UNROLLED (j, 0, 3)
      ABUT_UNROLLED (i, 0, 3) {
        const int k = i + 3 * j;
        p.entry[k] =
            fused(a, at.f.entry[k], fused(b, at.slope_of_second(i, j), Real(c * at.cof.entry[k])));
      }
    const Real volume = fused(broadcast<Real>(-2.0), log1p_lanes<N>(at.growth), growth);
    const Real w1 = fused(less, Real(3.0 + at.first), at.first);
    const Real w2 = fused(less_twice, Real(3.0 + at.second), at.second);
    energy = fused(broadcast<Real>(0.25 * moduli.bulk), volume,
                   fused(broadcast<Real>(numbers.c10), w1, Real(numbers.c01 * w2)));
    valid = at.jacobian;
  }
};

/// dP/dF of it. With a = 2 c10 J^(-2/3), b = 2 c01 J^(-4/3), g = dI2/dF/2 and Y = F^-T:
/// (a + b I1) d_ik d_JL + b (2 F_iJ F_kL - d_ik C_JL - F_iL F_kJ - b_ik d_JL) + Z_iJ Y_kL +
/// Y_iJ Z_kL + c Y_iL Y_kJ, Z = -2/3 a F - 4/3 b g + 1/2 (2/9 a I1 + 8/9 b I2 + kappa J^2) Y,
/// c = 1/3 a I1 + 2/3 b I2 - kappa/2 (J^2 - 1).
struct MooneyRivlinTangent {
  Moduli moduli;
  MooneyRivlinNumbers numbers;

  template <int N>
  [[gnu::always_inline]] void operator()(const TensorLanes<N>& h, ElasticityLanes<N>& out,
                                         typename Lanes<N>::Real& valid) const {
    using Real = typename Lanes<N>::Real;
    const InvariantLanes<N> at(h);
    const Real *f = at.f.entry, inverse = 1.0 / at.jacobian;
    const Real square = at.jacobian * at.jacobian, part = inverse_cube_root<N>(square);
    const Real a = (2.0 * numbers.c10) * part, b = (2.0 * numbers.c01) * part * part;
    const Real first = 3.0 + at.first, ai1 = a * first, bi2 = b * (3.0 + at.second);
    const Real bulk = broadcast<Real>(moduli.bulk);
    const Real half = fused(Real(0.5 * square), bulk, Real((1.0 / 9.0) * (ai1 + 4.0 * bi2)));
    const Real c = fused(Real(0.5 - 0.5 * square), bulk, Real((1.0 / 3.0) * (ai1 + 2.0 * bi2)));
    const Real same = fused(b, first, a);
    Real y[9], z[9], cy[9], bf[9], right[3][3], left[3][3];  // last: b C, b F F^T
    ABUT_UNROLLED (m, 0, 9) {
      y[m] = inverse * at.cof.entry[m];
      cy[m] = c * y[m];
      bf[m] = b * f[m];
      const Real slope = at.slope_of_second(m % 3, m / 3);
      z[m] = fused(half, y[m], Real((-2.0 / 3.0) * fused(a, f[m], Real(2.0 * b * slope))));
    }
    ABUT_UNROLLED (i, 0, 3)
      ABUT_UNROLLED (k, 0, 3) {
        right[i][k] = fused(bf[3 * i], f[3 * k],
                            fused(bf[3 * i + 1], f[3 * k + 1], Real(bf[3 * i + 2] * f[3 * k + 2])));
        left[i][k] = fused(bf[i], f[k], fused(bf[i + 3], f[k + 3], Real(bf[i + 6] * f[k + 6])));
      }
    fill_moduli(out, [&](int i, int j, int k, int l) ABUT_INLINED {
      const int ij = i + 3 * j, kl = k + 3 * l, il = i + 3 * l, kj = k + 3 * j;
      Real sum = cy[il] * y[kj];
      sum = fused(z[ij], y[kl], sum);
      sum = fused(y[ij], z[kl], sum);
      sum = fused(Real(2.0 * bf[ij]), f[kl], sum);
      sum = fused(Real(-bf[il]), f[kj], sum);
      if (i == k) sum -= right[j][l];
      if (j == l) sum -= left[i][k];
      if (i == k && j == l) sum += same;
      return sum;
    });
    valid = at.jacobian;
  }
};

}  // namespace abut
