#pragma once

#include <cstring>

#include "subdomain_solver/materials/lanes.hpp"

namespace abut {

/// exp(x) - 1 of lanes for x <= 64, to a few roundings; keeps the digits of small x. x = k ln 2 + r
/// with |r| <= ln(2)/2, where Taylor's series ends below rounding after fourteen terms; ln 2 in two
/// parts, the first with zeros enough that k times it is exact.
template <int N>
[[gnu::always_inline]] inline typename Lanes<N>::Real expm1_lanes(
    const typename Lanes<N>::Real& x) {
  using Real = typename Lanes<N>::Real;
  using Bits = typename Lanes<N>::Bits;
  const Real least = broadcast<Real>(-64.0);  // beyond, exp(x) is below the rounding of 1
  const Real within = x > least ? x : least;
  const Real magic = broadcast<Real>(0x1.8p52);  // its last bits count whole numbers
  const Real shifted = fused(within, broadcast<Real>(0x1.71547652b82fep+0), magic);
  const Real octaves = shifted - magic;
  const Real r = fused(octaves, broadcast<Real>(-0x1.a39ef35793c76p-33),
                       fused(octaves, broadcast<Real>(-0x1.62e42fee00000p-1), within));
  Real series = broadcast<Real>(1.0 / 14.0);
  ABUT_UNROLLED (k, 0, 12) {
    const double n = 13.0 - k;
    series = fused(Real(series * r), broadcast<Real>(1.0 / n), broadcast<Real>(1.0 / n));
  }
  series = fused(Real(series * r), r, r);
  Bits bits;
  std::memcpy(&bits, &shifted, sizeof bits);
  bits = (bits << 52) + 0x3ff0000000000000ul;
  Real power;  // 2^k
  std::memcpy(&power, &bits, sizeof power);
  return fused(power, series, Real(power - 1.0));
}

}  // namespace abut
