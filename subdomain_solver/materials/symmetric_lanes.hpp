#pragma once

#include "subdomain_solver/materials/lanes.hpp"

namespace abut {

/// A symmetric tensor at each of N points, entries xx yy zz xy yz zx.
template <class Real>
struct SymmetricLanes {
  Real at[6];
};

/// A B of tensors with the same principal axes, which is symmetric.
template <class Real>
[[gnu::always_inline]] inline void multiply(const SymmetricLanes<Real>& a,
                                            const SymmetricLanes<Real>& b,
                                            SymmetricLanes<Real>& out) {
  const Real *x = a.at, *y = b.at;
  out.at[0] = fused(x[0], y[0], fused(x[3], y[3], Real(x[5] * y[5])));
  out.at[1] = fused(x[3], y[3], fused(x[1], y[1], Real(x[4] * y[4])));
  out.at[2] = fused(x[5], y[5], fused(x[4], y[4], Real(x[2] * y[2])));
  out.at[3] = fused(x[0], y[3], fused(x[3], y[1], Real(x[5] * y[4])));
  out.at[4] = fused(x[3], y[5], fused(x[1], y[4], Real(x[4] * y[2])));
  out.at[5] = fused(x[5], y[0], fused(x[4], y[3], Real(x[2] * y[5])));
}

/// A : A
template <class Real>
[[gnu::always_inline]] inline Real squared_norm(const SymmetricLanes<Real>& a) {
  const Real off = fused(a.at[3], a.at[3], fused(a.at[4], a.at[4], Real(a.at[5] * a.at[5])));
  const Real on = fused(a.at[0], a.at[0], fused(a.at[1], a.at[1], Real(a.at[2] * a.at[2])));
  return fused(broadcast<Real>(2.0), off, on);
}

template <class Real>
[[gnu::always_inline]] inline Real determinant(const SymmetricLanes<Real>& a) {
  const Real* x = a.at;
  const Real first = fused(x[1], x[2], Real(-x[4] * x[4]));
  const Real second = fused(x[4], x[5], Real(-x[3] * x[2]));
  const Real third = fused(x[3], x[4], Real(-x[1] * x[5]));
  return fused(x[0], first, fused(x[3], second, Real(x[5] * third)));
}

/// Where a lane of the mask is set, `chosen` takes the place of `out`.
template <class Real, class Mask>
[[gnu::always_inline]] inline void take_where(const Mask& mask, const SymmetricLanes<Real>& chosen,
                                              SymmetricLanes<Real>& out) {
  ABUT_UNROLLED (k, 0, 6) out.at[k] = mask ? chosen.at[k] : out.at[k];
}

/// A symmetric D without trace, its square, and D^3 = j2 D + j3 I (Cayley and Hamilton): every
/// power of D is a sum of I, D and D^2, so that series in D are series of three numbers, which know
/// nothing of eigenvalues and lose no digits where two of them coincide.
template <class Real>
struct Deviator {
  SymmetricLanes<Real> tensor, square;
  Real j2, j3;

  [[gnu::always_inline]] explicit Deviator(const SymmetricLanes<Real>& d) : tensor(d) {
    multiply(d, d, square);
    j2 = 0.5 * (square.at[0] + square.at[1] + square.at[2]);
    j3 = determinant(d);
  }
};

/// k[0] I + k[1] D + k[2] D^2
template <class Real>
struct InPowers {
  Real k[3];

  /// The sum of coefficient[n] D^n for 1 <= n <= terms.
  template <int terms>
  [[gnu::always_inline]] static InPowers series(const Real& j2, const Real& j3,
                                                const double (&coefficient)[terms + 1]) {
    InPowers sum = {{broadcast<Real>(coefficient[terms]), Real{}, Real{}}};
    ABUT_UNROLLED (step, 1, terms + 1) {
      const int n = terms - step;
      const Real add = n > 0 ? broadcast<Real>(coefficient[n]) : Real{};
      const Real last = sum.k[2];
      sum.k[2] = sum.k[1];
      sum.k[1] = fused(j2, last, sum.k[0]);
      sum.k[0] = fused(j3, last, add);
    }
    return sum;
  }
};

}  // namespace abut
