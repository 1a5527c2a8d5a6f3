#pragma once

namespace abut {

/// s(a) = yield + modulus a + rise (1 - exp(-rate a)) [M.36] as kernels take it: numbers alone.
struct HardeningNumbers {
  double yield_stress = 0.0;  // [Pa]
  double modulus = 0.0;       // [Pa]
  double rise = 0.0;          // [Pa] by saturation; 0: none
  double rate = 0.0;          // [1] of it
};

}  // namespace abut
