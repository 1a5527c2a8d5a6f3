#pragma once

#include <algorithm>
#include <cmath>

namespace abut {

/// Largest mismatch of each exchanged field, scaled to a pure number: displacement by reference
/// velocity x step, velocity by the reference velocity, acceleration by reference velocity / step,
/// force by the largest contact force so far. Never by positions of the body: those hide any error
/// (docs/METHOD.md).
struct FieldResiduals {
  double displacement = 0.0, velocity = 0.0, acceleration = 0.0, force = 0.0;

  double largest() const { return std::max({displacement, velocity, acceleration, force}); }
  void include(const FieldResiduals& other, double factor = 1.0) {
    displacement = std::max(displacement, factor * other.displacement);
    velocity = std::max(velocity, factor * other.velocity);
    acceleration = std::max(acceleration, factor * other.acceleration);
    force = std::max(force, factor * other.force);
  }
};

/// Scales against which a window's mismatch is measured.
struct ReferenceScales {
  double velocity = 0.0;  // [m/s]
  double step = 0.0;      // [s]
  double force = 0.0;     // [N]
  double roundoff = 0.0;  // [m] displacements below it are round-off
};

/// |mismatch| / scale, 0 when the mismatch does not rise above round-off.
inline double scaled(double mismatch, double scale, double roundoff = 0.0) {
  const double size = std::abs(mismatch);
  if (size <= roundoff) return 0.0;
  return scale > 0.0 ? size / scale : HUGE_VAL;
}

}  // namespace abut
