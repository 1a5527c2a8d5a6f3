#pragma once

#include <cmath>
#include <numbers>

namespace abut {

/// Phase speed over wave speed of central difference with lumped mass: closed form of the discrete
/// dispersion relation sin(w dt / 2) = r sin(k h / 2), for a wave of `elements` per length and
/// r = c dt / h.
inline double phase_speed_lumped_explicit(double elements, double r) {
  const double half = std::numbers::pi / elements;
  return std::asin(r * std::sin(half)) / (r * half);
}

/// The same of the trapezoidal rule, tan(w dt / 2) = r sin(k h / 2) / sqrt(1 - 4 b sin^2(k h / 2)),
/// with b the off-diagonal share of the element mass: 0 lumped, 1/12 averaged, 1/6 consistent.
inline double phase_speed_trapezoidal(double elements, double r, double b) {
  const double half = std::numbers::pi / elements;
  const double s = std::sin(half);
  return std::atan(r * s / std::sqrt(1.0 - 4.0 * b * s * s)) / (r * half);
}

/// Final mean velocities of two bars, c = 1, the first with length, impedance and velocity 1, the
/// second at rest (characteristics; each row is one line of the tables A3 and A5 of the benchmark
/// catalogue).
struct UnequalImpact {
  double length;     // L2 / L1
  double impedance;  // Z2 / Z1
  double contact;    // [s] until the force ends
  double velocity1, velocity2;
};

}  // namespace abut
