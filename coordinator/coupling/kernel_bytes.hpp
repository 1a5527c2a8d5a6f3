#pragma once

namespace abut {

/// [B] of a port kernel of so many values over so many substeps, forces at the window's begin
/// included.
inline double kernel_bytes(double values, double substeps) {
  return 2.0 * static_cast<double>(sizeof(double)) * substeps * values * values;
}

/// [B] of a kernel that is not worth a band: contact takes bands of near points where a kernel of
/// all on all is larger.
constexpr double always_full_kernel = 64.0 * 1048576.0;
/// Facets around a point that answer a force on it in the narrowest band.
constexpr int fewest_rings = 2;

/// [B] of the same where points answer forces near them alone, in the narrowest band of a surface
/// of so many dimensions less one.
inline double banded_kernel_bytes(double points, int dim, double substeps) {
  const double across = 2.0 * fewest_rings + 1.0;
  const double reached = dim == 3 ? across * across : across;
  return 2.0 * static_cast<double>(sizeof(double)) * substeps * points * reached * dim * dim;
}

/// [B] of what finds the forces of so many rows one after the other, about, and of its compliance
/// of near points: as measured, 3 kB of a row in space.
inline double near_rows_bytes(double rows, int dim, bool rubs) {
  const double across = 2.0 * fewest_rings + 1.0, near = dim == 3 ? across * across : across;
  const double components = rubs ? static_cast<double>(dim * dim) : 1.0;
  return static_cast<double>(sizeof(double)) * rows * near * (dim * dim + components + 2.0);
}

}  // namespace abut
