#pragma once

#include <cstring>

#include "subdomain_solver/materials/lanes.hpp"

namespace abut {

/// ln(1 + e) for e > -1 of lanes, to a few roundings; keeps the digits of small e. The exponent of
/// 1 + e is split off so that the rest m lies between sqrt(1/2) and sqrt(2); then ln m =
/// 2 artanh((m - 1)/(m + 1)), whose series ends below rounding after eleven terms. Near 1 nothing
/// is split off and m - 1 is e itself.
template <int N>
[[gnu::always_inline]] inline typename Lanes<N>::Real log1p_lanes(
    const typename Lanes<N>::Real& e) {
  using Real = typename Lanes<N>::Real;
  using Bits = typename Lanes<N>::Bits;
  constexpr unsigned long root_half = 0x3fe6a09e667f3bcdul, one = 0x3ff0000000000000ul;
  const Real y = 1.0 + e;
  Bits bits;
  std::memcpy(&bits, &y, sizeof bits);
  bits += one - root_half;
  const Bits exponent = (bits >> 52) | 0x4330000000000000ul;  // 2^52 + exponent + 1023
  const Bits rest = (bits & 0x000ffffffffffffful) + root_half;
  Real octaves, m;
  std::memcpy(&octaves, &exponent, sizeof octaves);
  std::memcpy(&m, &rest, sizeof m);
  octaves -= 0x1p52 + 1023.0;
  const Real x = m == y ? e : m - 1.0;
  const Real s = x / (2.0 + x), square = s * s;
  Real series = broadcast<Real>(1.0 / 21.0);
  ABUT_UNROLLED (k, 0, 10) series = fused(series, square, broadcast<Real>(1.0 / (19.0 - 2.0 * k)));
  return fused(octaves, broadcast<Real>(0x1.62e42fefa39efp-1), Real(2.0 * s * series));
}

}  // namespace abut
