#pragma once

#include <cmath>

#include "subdomain_solver/materials/lanes.hpp"
#include "subdomain_solver/materials/moduli.hpp"

namespace abut {

// Laws for explicit work [M.31 to M.33, M.38]: the first Piola-Kirchhoff stress at N points at
// once, by the formulas that cost least. They agree with the scalar laws of the same names to
// rounding of a modulus (the scalar ones keep the digits of small strains too, and have tangents).
//
// stress(f, p, valid): F and P [Pa] (9, N); valid (N) is positive where the law has an answer: det
// F or, for small strains, 1. The caller collects it and checks once (all_positive). energy(h): W
// [J/m^3] (N) from H = F - I (9, N), for records: it keeps the digits of small strains.

/// cof F = J F^-T and J, entry i + 3 J each.
template <int N>
[[gnu::always_inline]] inline typename Lanes<N>::Real cofactor(const TensorLanes<N>& tensor,
                                                               TensorLanes<N>& cofactor) {
  using Real = typename Lanes<N>::Real;
  const Real* f = tensor.entry;
  ABUT_UNROLLED (j, 0, 3)
    ABUT_UNROLLED (i, 0, 3) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = 3 * ((j + 1) % 3), j2 = 3 * ((j + 2) % 3);
      cofactor.entry[i + 3 * j] = fused(f[i1 + j1], f[i2 + j2], Real(-f[i1 + j2] * f[i2 + j1]));
    }
  return fused(f[0], cofactor.entry[0],
               fused(f[1], cofactor.entry[1], Real(f[2] * cofactor.entry[2])));
}

template <int N>
[[gnu::always_inline]] inline typename Lanes<N>::Real squared_norm(const TensorLanes<N>& tensor) {
  using Real = typename Lanes<N>::Real;
  const Real* a = tensor.entry;
  Real sum = a[0] * a[0];
  ABUT_UNROLLED (k, 1, 9) sum = fused(a[k], a[k], sum);
  return sum;
}

/// lambda tr(e) I + 2 mu e of a symmetric e, entries 11 22 33 12 23 31; and half its work on e.
template <class Real>
struct HookeLanes {
  Real stress[6];

  [[gnu::always_inline]] HookeLanes(const Moduli& m, const Real (&e)[6]) {
    const Real mean = broadcast<Real>(m.lame()) * (e[0] + e[1] + e[2]);
    const Real twice = broadcast<Real>(2.0 * m.shear);
    ABUT_UNROLLED (k, 0, 3) stress[k] = fused(twice, e[k], mean);
    ABUT_UNROLLED (k, 3, 6) stress[k] = twice * e[k];
  }
  [[gnu::always_inline]] Real energy(const Real (&e)[6]) const {
    const Real normal = stress[0] * e[0] + stress[1] * e[1] + stress[2] * e[2];
    return 0.5 * normal + (stress[3] * e[3] + stress[4] * e[4] + stress[5] * e[5]);
  }
};

/// (H_ab + H_ba)/2, with H^T H added to the sum when `green`.
template <bool green, int a, int b, class Real>
[[gnu::always_inline]] inline Real strain_entry(const Real (&h)[9]) {
  const Real twice = h[a + 3 * b] + h[b + 3 * a];
  if constexpr (!green) return 0.5 * twice;
  return 0.5 * fused(h[3 * a], h[3 * b],
                     fused(h[1 + 3 * a], h[1 + 3 * b], fused(h[2 + 3 * a], h[2 + 3 * b], twice)));
}

/// Small or Green strain, entries 11 22 33 12 23 31.
template <bool green, class Real>
[[gnu::always_inline]] inline void strain_of(const Real (&h)[9], Real (&e)[6]) {
  e[0] = strain_entry<green, 0, 0>(h);
  e[1] = strain_entry<green, 1, 1>(h);
  e[2] = strain_entry<green, 2, 2>(h);
  e[3] = strain_entry<green, 0, 1>(h);
  e[4] = strain_entry<green, 1, 2>(h);
  e[5] = strain_entry<green, 2, 0>(h);
}

template <int N>
[[gnu::always_inline]] inline TensorLanes<N> minus_identity(const TensorLanes<N>& f) {
  TensorLanes<N> h = f;
  ABUT_UNROLLED (i, 0, 3) h.entry[4 * i] -= 1.0;
  return h;
}

struct BatchedLinearElastic {
  Moduli moduli;

  template <int N>
  [[gnu::always_inline]] void stress(const TensorLanes<N>& f, TensorLanes<N>& p,
                                     typename Lanes<N>::Real& valid) const {
    using Real = typename Lanes<N>::Real;
    Real e[6];
    strain_of<false>(minus_identity(f).entry, e);
    const HookeLanes<Real> hooke(moduli, e);
    const Real* s = hooke.stress;
    const Real entries[9] = {s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]};
    ABUT_UNROLLED (k, 0, 9) p.entry[k] = entries[k];
    valid = broadcast<Real>(1.0);
  }
  template <int N>
  [[gnu::always_inline]] typename Lanes<N>::Real energy(const TensorLanes<N>& h) const {
    using Real = typename Lanes<N>::Real;
    Real e[6];
    strain_of<false>(h.entry, e);
    return HookeLanes<Real>(moduli, e).energy(e);
  }
};

struct BatchedSaintVenantKirchhoff {
  Moduli moduli;

  template <int N>
  [[gnu::always_inline]] void stress(const TensorLanes<N>& f, TensorLanes<N>& p,
                                     typename Lanes<N>::Real& valid) const {
    using Real = typename Lanes<N>::Real;
    Real e[6];
    strain_of<true>(minus_identity(f).entry, e);
    const HookeLanes<Real> hooke(moduli, e);
    const Real* s = hooke.stress;
    const Real* g = f.entry;
    ABUT_UNROLLED (i, 0, 3) {  // P = F S
      p.entry[i] = fused(g[i], s[0], fused(g[i + 3], s[3], Real(g[i + 6] * s[5])));
      p.entry[i + 3] = fused(g[i], s[3], fused(g[i + 3], s[1], Real(g[i + 6] * s[4])));
      p.entry[i + 6] = fused(g[i], s[5], fused(g[i + 3], s[4], Real(g[i + 6] * s[2])));
    }
    TensorLanes<N> unused;
    valid = cofactor(f, unused);
  }
  template <int N>
  [[gnu::always_inline]] typename Lanes<N>::Real energy(const TensorLanes<N>& h) const {
    using Real = typename Lanes<N>::Real;
    Real e[6];
    strain_of<true>(h.entry, e);
    return HookeLanes<Real>(moduli, e).energy(e);
  }
};

struct BatchedNeoHookean {
  Moduli moduli;

  /// [M.38]
  template <int N>
  [[gnu::always_inline]] void stress(const TensorLanes<N>& f, TensorLanes<N>& p,
                                     typename Lanes<N>::Real& valid) const {
    using Real = typename Lanes<N>::Real;
    TensorLanes<N> cof;
    const Real j = cofactor(f, cof), square = j * j;
    const Real part = inverse_cube_root<N>(square);
    const Real a = moduli.shear * part;
    const Real pressure =
        fused(broadcast<Real>(0.5 * moduli.bulk), square, broadcast<Real>(-0.5 * moduli.bulk));
    const Real inverse = (j * part) * (part * part);
    const Real b = fused(a, Real(squared_norm(f) * (-1.0 / 3.0)), pressure) * inverse;
    ABUT_UNROLLED (k, 0, 9) p.entry[k] = fused(a, f.entry[k], Real(b * cof.entry[k]));
    valid = j;
  }
  template <int N>
  [[gnu::always_inline]] typename Lanes<N>::Real energy(const TensorLanes<N>& h) const {
    using Real = typename Lanes<N>::Real;
    TensorLanes<N> cof;
    const Real determinant = cofactor(h, cof);
    const Real trace = h.entry[0] + h.entry[4] + h.entry[8];
    const Real growth = trace + (cof.entry[0] + cof.entry[4] + cof.entry[8]) + determinant;
    const Real i1 = 2.0 * trace + squared_norm(h);  // I1 - 3
    Real w;
    ABUT_UNROLLED (l, 0, N) {
      const double log_volume = std::log1p(growth[l]);
      const double less = std::expm1(-2.0 / 3.0 * log_volume);  // J^(-2/3) - 1
      w[l] = 0.25 * moduli.bulk * (growth[l] * (2.0 + growth[l]) - 2.0 * log_volume) +
             0.5 * moduli.shear * (i1[l] + less * (3.0 + i1[l]));
    }
    return w;
  }
};

}  // namespace abut
