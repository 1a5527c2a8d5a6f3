#include "surface/sparse_rows.hpp"

#include <algorithm>
#include <cstddef>

#include "base/assert.hpp"
#include "base/index.hpp"

namespace abut {

void SparseRows::clear() {
  offsets.assign(1, 0);
  columns.clear();
  values.clear();
}

void append(const SparseRows& more, SparseRows& rows) {
  for (int r = 0; r < more.count(); ++r) {
    for (std::int32_t e = more.offsets[r]; e < more.offsets[index(r) + 1]; ++e) {
      rows.columns.push_back(more.columns[e]);
      rows.values.push_back(more.values[e]);
    }
    rows.end_row();
  }
}

void apply(const SparseRows& rows, int dim, std::span<const double> x, std::span<double> out) {
  ABUT_ASSERT(out.size() == index(rows.count() * dim));
  std::fill(out.begin(), out.end(), 0.0);
  for (int r = 0; r < rows.count(); ++r)
    for (std::int32_t e = rows.offsets[r]; e < rows.offsets[r + 1]; ++e)
      for (int d = 0; d < dim; ++d)
        out[dim * r + d] += rows.values[e] * x[dim * rows.columns[e] + d];
}

void add_transposed(const SparseRows& rows, int dim, double factor, std::span<const double> f,
                    std::span<double> out) {
  ABUT_ASSERT(f.size() == index(rows.count() * dim));
  for (int r = 0; r < rows.count(); ++r)
    for (std::int32_t e = rows.offsets[r]; e < rows.offsets[r + 1]; ++e)
      for (int d = 0; d < dim; ++d)
        out[dim * rows.columns[e] + d] += factor * rows.values[e] * f[dim * r + d];
}

}  // namespace abut
