#pragma once

#include "subdomain_solver/materials/symmetric_lanes.hpp"

namespace abut {

/// Root of lanes; fast where the compiler need not set errno.
template <class Real>
[[gnu::always_inline]] inline Real square_root(const Real& x) {
  Real root;
  ABUT_UNROLLED (i, 0, sizeof(Real) / sizeof(double)) root[i] = __builtin_sqrt(x[i]);
  return kept_whole(root);
}

template <class Real>
[[gnu::always_inline]] inline Real magnitude(const Real& x) {
  return x < 0.0 ? -x : x;
}

/// Principal values and axes of symmetric tensors, by turns of Jacobi's method, which loses no
/// digits where values coincide. Always the same number of turns, so that a lane's bits do not
/// depend on its neighbours: three by three matrices need five rounds at most, and what is diagonal
/// stays as it is.
template <class Real>
struct PrincipalLanes {
  Real value[3];
  Real axis[3][3];  // (component, number)

  [[gnu::always_inline]] explicit PrincipalLanes(const SymmetricLanes<Real>& tensor) {
    constexpr int rounds = 7;
    Real a[6];
    ABUT_UNROLLED (k, 0, 6) a[k] = tensor.at[k];
    ABUT_UNROLLED (i, 0, 3)
      ABUT_UNROLLED (k, 0, 3) axis[i][k] = broadcast<Real>(i == k ? 1.0 : 0.0);
    for (int round = 0; round < rounds; ++round) {
      turn<0, 1>(a[0], a[1], a[3], a[5], a[4]);
      turn<1, 2>(a[1], a[2], a[4], a[3], a[5]);
      turn<2, 0>(a[2], a[0], a[5], a[4], a[3]);
    }
    ABUT_UNROLLED (k, 0, 3) value[k] = a[k];
  }

  /// The tensor with these axes and the given principal values.
  [[gnu::always_inline]] void with_values(const Real (&v)[3], SymmetricLanes<Real>& out) const {
    constexpr int row[6] = {0, 1, 2, 0, 1, 2}, column[6] = {0, 1, 2, 1, 2, 0};
    ABUT_UNROLLED (k, 0, 6) {
      const Real *x = axis[row[k]], *y = axis[column[k]];
      out.at[k] =
          fused(Real(v[0] * x[0]), y[0], fused(Real(v[1] * x[1]), y[1], Real(v[2] * x[2] * y[2])));
    }
  }

 private:
  /// Turns axes p and q until `off`, which couples them, is zero; p_r and q_r couple them to the
  /// third.
  template <int p, int q>
  [[gnu::always_inline]] void turn(Real& of_p, Real& of_q, Real& off, Real& p_r, Real& q_r) {
    const Real apart = 0.5 * (of_q - of_p);
    const Real size = magnitude(apart) + square_root(Real(fused(apart, apart, Real(off * off))));
    const Real whole = size > 0.0 ? size : broadcast<Real>(1.0);
    const Real t = (apart < 0.0 ? -off : off) / whole;
    const Real cosine = 1.0 / square_root(Real(fused(t, t, broadcast<Real>(1.0))));
    const Real sine = t * cosine;
    of_p = fused(Real(-t), off, of_p);
    of_q = fused(t, off, of_q);
    off = Real{};
    rotate(cosine, sine, p_r, q_r);
    ABUT_UNROLLED (i, 0, 3) rotate(cosine, sine, axis[i][p], axis[i][q]);
  }
  [[gnu::always_inline]] static void rotate(const Real& cosine, const Real& sine, Real& x,
                                            Real& y) {
    const Real before = x;
    x = fused(cosine, before, Real(-sine * y));
    y = fused(sine, before, Real(cosine * y));
  }
};

}  // namespace abut
