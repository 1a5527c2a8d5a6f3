#pragma once

#include "subdomain_solver/materials/batched_j2.hpp"
#include "subdomain_solver/materials/batched_tangents.hpp"

namespace abut {

/// Moduli at N points that the tangent of a law in the logarithmic strain does not exceed [M.142]:
/// A <= l Y_iJ Y_kL + m Y_iL Y_kJ + (m + t) d_ik (Y^T Y)_JL with Y = F^-T. `left`: what stays of
/// the deviator.
template <int N>
[[gnu::always_inline]] inline void bound_moduli(const LogElasticLanes<N>& state,
                                                const typename Lanes<N>::Real& left,
                                                const Moduli& moduli, ElasticityLanes<N>& out,
                                                typename Lanes<N>::Real& valid) {
  using Real = typename Lanes<N>::Real;
  // What stays of the deviator scales mu. Principal values of a deviator e are below sqrt(2/3)
  // |e| and their differences below sqrt(2) |e|: x coth x <= 1 + x^2/3 of these.
  const Real soft = moduli.shear * left;
  const Real shear = fused(Real((2.0 / 3.0) * soft), state.square, soft);
  const Real lame = fused(broadcast<Real>(-2.0 / 3.0), soft, broadcast<Real>(moduli.bulk));
  const Real stress = fused(Real(1.6329931618554521 * soft), square_root(state.square),
                            Real(moduli.bulk * magnitude(state.strain.volume)));
  const Real whole = shear + stress;
  Real y[9], metric[3][3];
  ABUT_UNROLLED (m, 0, 9) y[m] = state.inverse * state.cof.entry[m];
  ABUT_UNROLLED (j, 0, 3)
    ABUT_UNROLLED (l, j, 3)
      metric[j][l] =
          whole * fused(y[3 * j], y[3 * l],
                        fused(y[3 * j + 1], y[3 * l + 1], Real(y[3 * j + 2] * y[3 * l + 2])));
  fill_moduli(out, [&](int i, int j, int k, int l) ABUT_INLINED {
    Real sum = (lame * y[i + 3 * j]) * y[k + 3 * l];
    sum = fused(Real(shear * y[i + 3 * l]), y[k + 3 * j], sum);
    if (i == k) sum += metric[j][l];
    return sum;
  });
  valid = state.answers();
}

struct J2Bound {
  const Moduli& moduli;
  const HardeningNumbers& hardening;

  template <int N>
  [[gnu::always_inline]] void operator()(const TensorLanes<N>& h, const J2HistoryLanes<N>& before,
                                         ElasticityLanes<N>& out,
                                         typename Lanes<N>::Real& valid) const {
    const J2Lanes<N> state(moduli, hardening, h, before);
    bound_moduli<N>(state, state.left, moduli, out, valid);
  }
};

struct HenckyBound {
  Moduli moduli;

  template <int N>
  [[gnu::always_inline]] void operator()(const TensorLanes<N>& h, ElasticityLanes<N>& out,
                                         typename Lanes<N>::Real& valid) const {
    using Real = typename Lanes<N>::Real;
    bound_moduli<N>(HenckyLanes<N>(h), broadcast<Real>(1.0), moduli, out, valid);
  }
};

}  // namespace abut
