#pragma once

#include "subdomain_solver/materials/batched_laws.hpp"

namespace abut {

/// dP_iJ/dF_kL [Pa] at N points: block (J, L) for J <= L, the others by symmetry.
template <int N>
struct ElasticityLanes {
  typename Lanes<N>::Real at[3][3][3][3];  // (J, L, i, k), J <= L
};

template <int N, class Entry>
[[gnu::always_inline]] inline void fill_moduli(ElasticityLanes<N>& out, const Entry& entry) {
  ABUT_UNROLLED (j, 0, 3)
    ABUT_UNROLLED (l, j, 3)
      ABUT_UNROLLED (i, 0, 3)
        ABUT_UNROLLED (k, 0, 3) out.at[j][l][i][k] = entry(i, j, k, l);
}

// Tangents of the batched laws at F = H + I; they agree with the scalar laws to rounding. `valid`
// is positive where the law has an answer, as in batched_laws.hpp.

/// Constant; explicit steps of linear bodies have no use for it but in tests.
struct LinearElasticTangent {
  Moduli moduli;

  template <int N>
  [[gnu::always_inline]] void operator()(const TensorLanes<N>&, ElasticityLanes<N>& out,
                                         typename Lanes<N>::Real& valid) const {
    using Real = typename Lanes<N>::Real;
    const double lame = moduli.lame(), mu = moduli.shear;
    fill_moduli(out, [lame, mu](int i, int j, int k, int l) ABUT_INLINED {
      return broadcast<Real>((i == j && k == l ? lame : 0.0) + (i == k && j == l ? mu : 0.0) +
                             (i == l && k == j ? mu : 0.0));
    });
    valid = broadcast<Real>(1.0);
  }
};

/// d_ik S_JL + lambda F_iJ F_kL + mu (b_ik d_JL + F_iL F_kJ), b = F F^T
struct SaintVenantKirchhoffTangent {
  Moduli moduli;

  template <int N>
  [[gnu::always_inline]] void operator()(const TensorLanes<N>& h, ElasticityLanes<N>& out,
                                         typename Lanes<N>::Real& valid) const {
    using Real = typename Lanes<N>::Real;
    TensorLanes<N> f = h, unused;
    ABUT_UNROLLED (i, 0, 3) f.entry[4 * i] += 1.0;
    Real e[6];
    strain_of<true>(h.entry, e);
    const HookeLanes<Real> hooke(moduli, e);
    const Real* s = hooke.stress;
    const Real stress[3][3] = {{s[0], s[3], s[5]}, {s[3], s[1], s[4]}, {s[5], s[4], s[2]}};
    Real finger[3][3], scaled[9];
    ABUT_UNROLLED (i, 0, 3)
      ABUT_UNROLLED (k, 0, 3)
        finger[i][k] = moduli.shear * fused(f.entry[i], f.entry[k],
                                            fused(f.entry[i + 3], f.entry[k + 3],
                                                  Real(f.entry[i + 6] * f.entry[k + 6])));
    ABUT_UNROLLED (m, 0, 9) scaled[m] = moduli.shear * f.entry[m];
    const Real ratio = broadcast<Real>(moduli.lame() / moduli.shear);
    fill_moduli(out, [&](int i, int j, int k, int l) ABUT_INLINED {
      Real sum = scaled[i + 3 * l] * f.entry[k + 3 * j];
      sum = fused(Real(ratio * scaled[i + 3 * j]), f.entry[k + 3 * l], sum);
      if (i == k) sum += stress[j][l];
      if (j == l) sum += finger[i][k];
      return sum;
    });
    valid = cofactor(f, unused);
  }
};

/// a d_ik d_JL + Z_iJ Y_kL + Y_iJ Z_kL + c Y_iL Y_kJ with Y = F^-T, a = mu J^(-2/3),
/// Z = -2/3 a F + 1/2 (2/9 a I1 + kappa J^2) Y, c = 1/3 a I1 - kappa/2 (J^2 - 1) [M.33]
struct NeoHookeanTangent {
  Moduli moduli;

  template <int N>
  [[gnu::always_inline]] void operator()(const TensorLanes<N>& h, ElasticityLanes<N>& out,
                                         typename Lanes<N>::Real& valid) const {
    using Real = typename Lanes<N>::Real;
    TensorLanes<N> f = h, y;
    ABUT_UNROLLED (i, 0, 3) f.entry[4 * i] += 1.0;
    const Real j = cofactor(f, y), square = j * j, inverse = 1.0 / j;
    const Real a = moduli.shear * inverse_cube_root<N>(square);
    const Real ai1 = a * squared_norm(f), bulk = broadcast<Real>(moduli.bulk);
    const Real half = fused(Real(0.5 * square), bulk, Real((1.0 / 9.0) * ai1));
    const Real c = fused(Real(0.5 - 0.5 * square), bulk, Real((1.0 / 3.0) * ai1));
    const Real b = (-2.0 / 3.0) * a;
    Real z[9], cy[9];
    ABUT_UNROLLED (m, 0, 9) {
      y.entry[m] *= inverse;
      z[m] = fused(b, f.entry[m], Real(half * y.entry[m]));
      cy[m] = c * y.entry[m];
    }
    fill_moduli(out, [&](int i, int j0, int k, int l) ABUT_INLINED {
      Real sum = cy[i + 3 * l] * y.entry[k + 3 * j0];
      sum = fused(z[i + 3 * j0], y.entry[k + 3 * l], sum);
      sum = fused(y.entry[i + 3 * j0], z[k + 3 * l], sum);
      if (i == k && j0 == l) sum += a;
      return sum;
    });
    valid = j;
  }
};

}  // namespace abut
