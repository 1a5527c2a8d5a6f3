#pragma once

#include "subdomain_solver/materials/hardening_numbers.hpp"
#include "subdomain_solver/materials/lane_exponential.hpp"
#include "subdomain_solver/materials/lanes.hpp"

namespace abut {

/// The yield stress, its slope and the energy that hardening stores at equivalent plastic strains.
template <int N>
struct HardeningLanes {
  using Real = typename Lanes<N>::Real;
  const HardeningNumbers& numbers;
  Real a, saturated;  // exp(-rate a) - 1, where there is a part that saturates

  [[gnu::always_inline]] HardeningLanes(const HardeningNumbers& h, const Real& at)
      : numbers(h), a(at), saturated(Real{}) {
    if (h.rise > 0.0) saturated = expm1_lanes<N>(Real(-h.rate * at));
  }
  [[gnu::always_inline]] Real stress() const {  // [Pa]
    const Real linear =
        fused(broadcast<Real>(numbers.modulus), a, broadcast<Real>(numbers.yield_stress));
    return fused(broadcast<Real>(-numbers.rise), saturated, linear);
  }
  [[gnu::always_inline]] Real slope() const {  // [Pa]
    const double steepest = numbers.rise * numbers.rate;
    return fused(broadcast<Real>(steepest), saturated, broadcast<Real>(numbers.modulus + steepest));
  }
  [[gnu::always_inline]] Real stored() const {  // [J/m^3]
    const Real linear = (0.5 * numbers.modulus) * a * a;
    if (!(numbers.rise > 0.0)) return linear;
    return fused(broadcast<Real>(numbers.rise), Real(a + (1.0 / numbers.rate) * saturated), linear);
  }
};

}  // namespace abut
