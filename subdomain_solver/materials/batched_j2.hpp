#pragma once

#include <limits>

#include "subdomain_solver/materials/batched_log_elastic.hpp"
#include "subdomain_solver/materials/lane_hardening.hpp"

namespace abut {

/// History of J2 plasticity at N points, in the order of the scalar law: the inverse plastic right
/// Cauchy-Green tensor minus I, then the equivalent plastic strain.
template <int N>
struct J2HistoryLanes {
  static constexpr int size = 7;
  typename Lanes<N>::Real at[size];
};

/// J2 plasticity [M.36] from H = F - I at N points at once. Agrees with the scalar law to rounding
/// of a modulus. Points that do not yield share no work with those that do but what a batch asks
/// for, and their bits do not depend on it.
template <int N>
struct J2Lanes : LogElasticLanes<N> {
  using Real = typename Lanes<N>::Real;
  using Bits = typename Lanes<N>::Bits;
  using Elastic = LogElasticLanes<N>;
  using Elastic::cof, Elastic::inverse, Elastic::strain, Elastic::square, Elastic::valid;

  Real flow, left;  // increment of plastic strain; share of the trial deviator that stays
  Bits yields;

  [[gnu::always_inline]] J2Lanes(const Moduli& moduli, const HardeningNumbers& hardening,
                                 const TensorLanes<N>& h, const J2HistoryLanes<N>& before)
      : Elastic(h, trial_strain(h, before)) {
    flow = Real{};
    left = broadcast<Real>(1.0);
    const HardeningLanes<N> now(hardening, before.at[6]);
    const Real limit = now.stress();
    const double mu = moduli.shear;
    yields = (6.0 * mu * mu) * square > limit * limit;  // von Mises stress over yield stress
    if (some_yield()) return_to_surface(mu, now);
  }

  [[gnu::always_inline]] bool some_yield() const {
    bool some = false;
    ABUT_UNROLLED (l, 0, N) some = some || yields[l] != 0;
    return some;
  }

  /// P = tau F^-T [Pa]
  [[gnu::always_inline]] void stress(const Moduli& moduli, TensorLanes<N>& p) const {
    Elastic::stress(moduli, left, p);
  }

  /// [J/m^3] elastic, and what hardening stores.
  [[gnu::always_inline]] Real energy(const Moduli& moduli, const HardeningNumbers& hardening,
                                     const J2HistoryLanes<N>& after) const {
    const HardeningLanes<N> now(hardening, after.at[6]);
    return Elastic::energy(moduli, left, now.stored());
  }

  /// C_p^-1 changes by F^-1 (b_e - b_e of the trial) F^-T: a difference, as in the scalar law.
  [[gnu::always_inline]] void advance(const J2HistoryLanes<N>& before,
                                      J2HistoryLanes<N>& after) const {
    after = before;
    if (!some_yield()) return;
    after.at[6] += flow;
    SymmetricLanes<Real> change = strain.change(Real(2.0 * left - 2.0));
    const Real scale = inverse * inverse;
    ABUT_UNROLLED (k, 0, 6) change.at[k] *= scale;
    const Real *x = change.at, *c = cof.entry;
    Real turned[9];  // change . cof F
    ABUT_UNROLLED (j, 0, 3) {
      const Real* y = c + 3 * j;
      turned[3 * j] = fused(x[0], y[0], fused(x[3], y[1], Real(x[5] * y[2])));
      turned[3 * j + 1] = fused(x[3], y[0], fused(x[1], y[1], Real(x[4] * y[2])));
      turned[3 * j + 2] = fused(x[5], y[0], fused(x[4], y[1], Real(x[2] * y[2])));
    }
    constexpr int row[6] = {0, 1, 2, 0, 1, 2}, column[6] = {0, 1, 2, 1, 2, 0};
    ABUT_UNROLLED (k, 0, 6) {
      const Real *y = c + 3 * row[k], *z = turned + 3 * column[k];
      const Real sum = fused(y[0], z[0], fused(y[1], z[1], fused(y[2], z[2], before.at[k])));
      after.at[k] = yields ? sum : before.at[k];
    }
  }

 private:
  /// b_e - I = H^T + (H + F G) F^T, where G is C_p^-1 - I: small where strains are.
  [[gnu::always_inline]] static SymmetricLanes<Real> trial_strain(const TensorLanes<N>& h,
                                                                  const J2HistoryLanes<N>& before) {
    TensorLanes<N> f = h;
    ABUT_UNROLLED (i, 0, 3) f.entry[4 * i] += 1.0;
    const Real* g = before.at;
    Real k[9];
    ABUT_UNROLLED (i, 0, 3) {
      const Real x = f.entry[i], y = f.entry[i + 3], z = f.entry[i + 6];
      k[i] = fused(x, g[0], fused(y, g[3], fused(z, g[5], h.entry[i])));
      k[i + 3] = fused(x, g[3], fused(y, g[1], fused(z, g[4], h.entry[i + 3])));
      k[i + 6] = fused(x, g[5], fused(y, g[4], fused(z, g[2], h.entry[i + 6])));
    }
    constexpr int row[6] = {0, 1, 2, 0, 1, 2}, column[6] = {0, 1, 2, 1, 2, 0};
    SymmetricLanes<Real> e;
    ABUT_UNROLLED (m, 0, 6) {
      const int i = row[m], j = column[m];
      e.at[m] = fused(
          k[i], f.entry[j],
          fused(k[i + 3], f.entry[j + 3], fused(k[i + 6], f.entry[j + 6], h.entry[j + 3 * i])));
    }
    return e;
  }

  /// The equation for the increment, as the scalar law solves it: in one step where hardening is
  /// linear, else by Newton's method, which every lane leaves when it has its root.
  [[gnu::always_inline]] void return_to_surface(double mu, const HardeningLanes<N>& now) {
    const HardeningNumbers& hardening = now.numbers;
    const double stiff = 3.0 * mu;
    const Real mises = square_root(Real((6.0 * mu * mu) * square));
    const Real safe = yields ? mises : broadcast<Real>(1.0);
    Real p = (mises - now.stress()) / (stiff + now.slope());
    if (hardening.rise > 0.0) {
      constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon();
      Bits open = yields;
      for (int i = 0; i < 100; ++i) {
        const HardeningLanes<N> there(hardening, Real(now.a + p));
        const Real excess = fused(broadcast<Real>(-stiff), p, mises) - there.stress();
        const Real step = open ? excess / (stiff + there.slope()) : Real{};
        p += step;
        open &= ~(magnitude(step) <= rounding * (mises * (1.0 / stiff) + there.a));
        bool some = false;
        ABUT_UNROLLED (l, 0, N) some = some || open[l] != 0;
        if (!some) break;
      }
      valid &= ~open;
    }
    flow = yields ? p : Real{};
    left = fused(broadcast<Real>(-stiff), Real(flow / safe), broadcast<Real>(1.0));
  }
};

}  // namespace abut
