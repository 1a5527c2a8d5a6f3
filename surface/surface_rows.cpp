#include "surface/surface_rows.hpp"

#include <cstddef>

#include "base/assert.hpp"
#include "base/index.hpp"

namespace abut {
namespace {

/// Component d of one row applied to the positions of nodes.
double component(const SparseRows& rows, int r, int dim, int d, std::span<const double> x) {
  double sum = 0.0;
  for (std::int32_t e = rows.offsets[r]; e < rows.offsets[r + 1]; ++e)
    sum += rows.values[e] * x[dim * rows.columns[e] + d];
  return sum;
}

}  // namespace

void SurfaceRows::clear() {
  nodes.clear();
  weights.clear();
  normals.clear();
  gaps.clear();
  k.clear();
  n.clear();
}

void gaps(const SurfaceRows& rows, std::span<const double> x, std::span<const double> y,
          std::span<double> out) {
  ABUT_ASSERT(out.size() == index(rows.count()));
  for (int r = 0; r < rows.count(); ++r) {
    out[r] = 0.0;
    for (int d = 0; d < rows.dim; ++d)
      out[r] += rows.normals[rows.dim * r + d] *
                (component(rows.k, r, rows.dim, d, x) - component(rows.n, r, rows.dim, d, y));
  }
}

}  // namespace abut
