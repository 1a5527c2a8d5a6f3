#pragma once

#include "coordinator/coupling/tie_band.hpp"

namespace abut {

/// What a scene says of the kernels of ties.
struct TieKernelOptions {
  bool used = true;                   // false: they only say what a force is worth
  double memory = 2048.0 * 1048576.0;  // [B] of a net
  bool banded = false;                // even where every row on every other one fits
  std::optional<double> rows;         // spacings of a band; absent: as far as waves come
};

/// The kernel of a net, and what it takes.
struct TieKernelPlan {
  bool banded = false;
  TieBandWidth width;
  int lags = 0;         // blocks; what a force does after them is left out
  double bytes = 0.0;   // about
  int probes = 0;       // patterns that bodies are pressed with
  bool narrow = false;  // waves may leave the bands, or their lags
};

/// Every row on every other one where that fits, else bands, as wide as fit. What has no inertia is
/// felt everywhere at once: beside such bodies every row on every other one, whatever it takes.
TieKernelPlan plan_tie_kernel(const TieLayout& layout, const TieKernelOptions& options,
                              const Bodies& bodies);

}  // namespace abut
