#pragma once

#include "subdomain_solver/materials/batched_log_elastic.hpp"
#include "subdomain_solver/materials/batched_mooney_rivlin.hpp"

namespace abut {

/// What a law answers at N points: P [Pa], W [J/m^3], what laws with a history dissipate in the
/// step [J/m^3], and `valid`, positive where there is an answer.
template <int N>
struct LaneResponse {
  TensorLanes<N> stress;
  typename Lanes<N>::Real energy, dissipation, valid;
};

/// Sums over the points of cells; `dissipates`: the law does.
template <int N, bool dissipates>
struct PointSums {
  typename Lanes<N>::Real stored, dissipated;  // [J]
  typename Lanes<N>::Bits valid;

  /// volume: [m^3] that the points stand for.
  [[gnu::always_inline]] void add(const typename Lanes<N>::Real& volume,
                                  const LaneResponse<N>& response) {
    stored = fused(volume, response.energy, stored);
    if constexpr (dissipates) dissipated = fused(volume, response.dissipation, dissipated);
    valid &= response.valid > 0.0;
  }
};

// Stress and energy of the batched laws in one go, from H = F - I, sharing what both need.

struct LinearElasticResponse {
  Moduli moduli;

  template <int N>
  [[gnu::always_inline]] void operator()(const TensorLanes<N>& h, LaneResponse<N>& out) const {
    using Real = typename Lanes<N>::Real;
    Real e[6];
    strain_of<false>(h.entry, e);
    const HookeLanes<Real> hooke(moduli, e);
    const Real* s = hooke.stress;
    const Real entries[9] = {s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]};
    ABUT_UNROLLED (k, 0, 9) out.stress.entry[k] = entries[k];
    out.energy = hooke.energy(e);
    out.valid = broadcast<Real>(1.0);
  }
};

template <int N>
[[gnu::always_inline]] inline TensorLanes<N> plus_identity(const TensorLanes<N>& h) {
  TensorLanes<N> f = h;
  ABUT_UNROLLED (i, 0, 3) f.entry[4 * i] += 1.0;
  return f;
}

struct SaintVenantKirchhoffResponse {
  Moduli moduli;

  template <int N>
  [[gnu::always_inline]] void operator()(const TensorLanes<N>& h, LaneResponse<N>& out) const {
    using Real = typename Lanes<N>::Real;
    Real e[6];
    strain_of<true>(h.entry, e);
    const HookeLanes<Real> hooke(moduli, e);
    const Real* s = hooke.stress;
    const TensorLanes<N> f = plus_identity(h);
    const Real* g = f.entry;
    ABUT_UNROLLED (i, 0, 3) {  // P = F S
      out.stress.entry[i] = fused(g[i], s[0], fused(g[i + 3], s[3], Real(g[i + 6] * s[5])));
      out.stress.entry[i + 3] = fused(g[i], s[3], fused(g[i + 3], s[1], Real(g[i + 6] * s[4])));
      out.stress.entry[i + 6] = fused(g[i], s[5], fused(g[i + 3], s[4], Real(g[i + 6] * s[2])));
    }
    out.energy = hooke.energy(e);
    TensorLanes<N> unused;
    out.valid = cofactor(f, unused);
  }
};

struct NeoHookeanResponse {
  Moduli moduli;

  template <int N>
  [[gnu::always_inline]] void operator()(const TensorLanes<N>& h, LaneResponse<N>& out) const {
    using Real = typename Lanes<N>::Real;
    const TensorLanes<N> f = plus_identity(h);
    BatchedNeoHookean{moduli}.stress(f, out.stress, out.valid);
    // W from H keeps the digits of small strains: J - 1 and I1 - 3 are no differences.
    TensorLanes<N> minors;
    const Real determinant = cofactor(h, minors);
    const Real trace = h.entry[0] + h.entry[4] + h.entry[8];
    const Real growth = trace + (minors.entry[0] + minors.entry[4] + minors.entry[8]) + determinant;
    const Real square_growth = fused(growth, growth, Real(2.0 * growth));  // J^2 - 1
    const Real i1 = fused(broadcast<Real>(2.0), trace, squared_norm(h));   // I1 - 3
    // d = J^(-2/3) - 1 solves (1 + d)^3 J^2 = 1; one step of Newton's method restores the digits
    // that J^(-2/3) loses near 1.
    const Real part = inverse_cube_root<N>(out.valid * out.valid);
    const Real d = part - 1.0;
    const Real cube = d * fused(d, Real(3.0 + d), broadcast<Real>(3.0));  // (1 + d)^3 - 1
    const Real residual = fused(cube, square_growth, Real(cube + square_growth));
    const Real less = fused(residual, Real(part * (-1.0 / 3.0)), d);
    const Real volume = fused(broadcast<Real>(-2.0), log1p_lanes<N>(growth), square_growth);
    const Real shape = fused(less, Real(3.0 + i1), i1);
    out.energy =
        fused(broadcast<Real>(0.25 * moduli.bulk), volume, Real((0.5 * moduli.shear) * shape));
  }
};

struct MooneyRivlinResponse {
  Moduli moduli;
  MooneyRivlinNumbers numbers;

  template <int N>
  [[gnu::always_inline]] void operator()(const TensorLanes<N>& h, LaneResponse<N>& out) const {
    BatchedMooneyRivlin{moduli, numbers}.respond(h, out.stress, out.energy, out.valid);
  }
};

struct HenckyResponse {
  Moduli moduli;

  template <int N>
  [[gnu::always_inline]] void operator()(const TensorLanes<N>& h, LaneResponse<N>& out) const {
    using Real = typename Lanes<N>::Real;
    const HenckyLanes<N> state(h);
    const Real all = broadcast<Real>(1.0);  // of the deviator
    state.stress(moduli, all, out.stress);
    out.energy = state.energy(moduli, all, Real{});
    out.valid = state.answers();
  }
};

}  // namespace abut
