#pragma once

#include "subdomain_solver/materials/lane_exponential.hpp"
#include "subdomain_solver/materials/lane_logarithm.hpp"
#include "subdomain_solver/materials/lane_principal_axes.hpp"
#include "subdomain_solver/materials/symmetric_lanes.hpp"

namespace abut {

/// Logarithmic strain ln(b)/2 of b = I + E at N points, and exponentials of its deviator. Where the
/// shape of b is near that of a sphere, as that of metals always is, both are series in the
/// deviator of b [M.141]; elsewhere they are found in principal axes.
template <int N>
struct LogStrainLanes {
  using Real = typename Lanes<N>::Real;
  using Bits = typename Lanes<N>::Bits;

  SymmetricLanes<Real> deviator;  // of the strain
  Real volume;                    // its trace
  Bits valid;                     // where b is positive definite

  [[gnu::always_inline]] explicit LogStrainLanes(const SymmetricLanes<Real>& e) : elastic_(e) {
    const Real mean = (1.0 / 3.0) * (e.at[0] + e.at[1] + e.at[2]), inverse = 1.0 / (1.0 + mean);
    SymmetricLanes<Real> d;
    ABUT_UNROLLED (k, 0, 3) d.at[k] = (e.at[k] - mean) * inverse;
    ABUT_UNROLLED (k, 3, 6) d.at[k] = e.at[k] * inverse;
    const Deviator<Real> shape(d);
    valid = mean > -1.0;
    far_ = valid & ~(shape.j2 <= 0.5 * largest_norm * largest_norm);
    // Principal values of the deviator are below 0.103 there: the next term is 1e-17 of the first.
    const InPowers<Real> logarithm =
        InPowers<Real>::template series<16>(shape.j2, shape.j3, of_logarithm);
    const Real* k = logarithm.k;
    volume = fused(broadcast<Real>(1.5), Real(k[0] + log1p_lanes<N>(mean)), Real(k[2] * shape.j2));
    const Real third = (2.0 / 3.0) * shape.j2;
    ABUT_UNROLLED (i, 0, 6) {
      const Real square = i < 3 ? shape.square.at[i] - third : shape.square.at[i];
      deviator.at[i] = 0.5 * fused(k[1], d.at[i], Real(k[2] * square));
    }
    if (any(far_)) set_far(shape, mean);
  }

  /// b (exp(factor x deviator) - I) for |factor| <= 2.
  [[gnu::always_inline]] SymmetricLanes<Real> change(const Real& factor) const {
    SymmetricLanes<Real> d, power, out;
    ABUT_UNROLLED (k, 0, 6) d.at[k] = factor * deviator.at[k];
    const Deviator<Real> flow(d);
    const InPowers<Real> less =
        InPowers<Real>::template series<10>(flow.j2, flow.j3, of_exponential);
    ABUT_UNROLLED (k, 0, 6) {
      power.at[k] = fused(less.k[1], d.at[k], Real(less.k[2] * flow.square.at[k]));
      if (k < 3) power.at[k] += less.k[0];
    }
    multiply(elastic_, power, out);
    ABUT_UNROLLED (k, 0, 6) out.at[k] += power.at[k];
    if (any(far_)) take_where(far_, change_by_axes(factor), out);
    return out;
  }

 private:
  /// Coefficients of ln(1 + x) and exp(x) - 1 by powers of x.
  static constexpr double of_logarithm[17] = {
      0.0,         1.0,        -1.0 / 2.0,  1.0 / 3.0,  -1.0 / 4.0,  1.0 / 5.0,
      -1.0 / 6.0,  1.0 / 7.0,  -1.0 / 8.0,  1.0 / 9.0,  -1.0 / 10.0, 1.0 / 11.0,
      -1.0 / 12.0, 1.0 / 13.0, -1.0 / 14.0, 1.0 / 15.0, -1.0 / 16.0};
  static constexpr double of_exponential[11] = {
      0.0,         1.0,          1.0 / 2.0,     1.0 / 6.0,      1.0 / 24.0,     1.0 / 120.0,
      1.0 / 720.0, 1.0 / 5040.0, 1.0 / 40320.0, 1.0 / 362880.0, 1.0 / 3628800.0};
  static constexpr double largest_norm = 0.125;  // of the deviator of b over a third of its trace

  [[gnu::always_inline]] static bool any(const Bits& mask) {
    bool found = false;
    ABUT_UNROLLED (l, 0, N) found = found || mask[l] != 0;
    return found;
  }

  /// The axis of the principal value that lies farthest from the others, and the plane across
  /// [M.157].
  [[gnu::always_inline]] void set_far(const Deviator<Real>& shape, const Real& mean) {
    const Real *d = shape.tensor.at, j2 = far_ ? shape.j2 : broadcast<Real>(1.0);
    const Real root = square_root(j2), s = magnitude(shape.j3) / (j2 * root);
    // t = 1 + x of t^3 - t = s, between 1 and 2/sqrt(3): a guess to 2e-3, squared three times.
    Real x = s * fused(broadcast<Real>(-0.2557), s, broadcast<Real>(0.5));
    ABUT_UNROLLED (step, 0, 3) {
      const Real value = fused(x, fused(x, Real(3.0 + x), broadcast<Real>(2.0)), Real(-s));
      x -= value /
           fused(x, fused(broadcast<Real>(3.0), x, broadcast<Real>(6.0)), broadcast<Real>(2.0));
    }
    const Real size = fused(root, x, root), one = shape.j3 < 0.0 ? -size : size;
    const Real rest = fused(one, one, Real(-j2)), scale = 1.0 / fused(Real(2.0 * one), one, rest);
    SymmetricLanes<Real> axis, across;  // its projector less a third; what is left of D across it
    ABUT_UNROLLED (k, 0, 6) {
      const Real on = k < 3 ? Real(shape.square.at[k] + rest) : shape.square.at[k];
      axis.at[k] = scale * fused(one, d[k], on);
      across.at[k] = fused(Real(-1.5 * one), axis.at[k], k < 3 ? Real(d[k] + 0.5 * one) : d[k]);
      if (k < 3) axis.at[k] -= 1.0 / 3.0;
    }
    const Real apart = square_root(Real(2.0 * squared_norm(across)));
    const Real low = -0.5 * (one + apart), inverse = 1.0 / (1.0 + low), ratio = apart * inverse;
    const Real higher = log1p_lanes<N>(ratio);  // ln of the ratio of the two in the plane
    const Real in_plane = fused(broadcast<Real>(0.5), higher, log1p_lanes<N>(low));
    const Real along = log1p_lanes<N>(one), difference = 0.5 * (along - in_plane);
    const Real slope = 0.5 * (apart > 0.0 ? higher / apart : inverse);
    ABUT_UNROLLED (k, 0, 6) {
      const Real whole = fused(difference, axis.at[k], Real(slope * across.at[k]));
      deviator.at[k] = far_ ? whole : deviator.at[k];
    }
    const Real sum =
        fused(broadcast<Real>(1.5), log1p_lanes<N>(mean), Real(0.5 * along + in_plane));
    volume = far_ ? sum : volume;
    Bits positive = one > -1.0;
    positive &= low > -1.0;
    valid &= positive | ~far_;
  }
  [[gnu::always_inline]] SymmetricLanes<Real> change_by_axes(const Real& factor) const {
    const PrincipalLanes<Real> principal(elastic_);
    Real strain[3], values[3];
    ABUT_UNROLLED (a, 0, 3) strain[a] = 0.5 * log1p_lanes<N>(principal.value[a]);
    const Real mean = (1.0 / 3.0) * (strain[0] + strain[1] + strain[2]);
    ABUT_UNROLLED (a, 0, 3)
      values[a] = (1.0 + principal.value[a]) * expm1_lanes<N>(Real(factor * (strain[a] - mean)));
    SymmetricLanes<Real> out;
    principal.with_values(values, out);
    return out;
  }

  SymmetricLanes<Real> elastic_;  // b - I
  Bits far_;                      // where principal axes are taken
};

}  // namespace abut
