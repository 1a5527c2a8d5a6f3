#pragma once

namespace abut {

/// [B] of a port kernel of so many values over so many substeps, forces at the window's begin
/// included.
inline double kernel_bytes(double values, double substeps) {
  return 2.0 * static_cast<double>(sizeof(double)) * substeps * values * values;
}

}  // namespace abut
