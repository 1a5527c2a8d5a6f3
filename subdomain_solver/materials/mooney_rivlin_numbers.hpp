#pragma once

namespace abut {

/// Factors of the invariants in the energy, for batched work.
struct MooneyRivlinNumbers {
  double c10 = 0.0, c01 = 0.0;  // [Pa]
};

}  // namespace abut
