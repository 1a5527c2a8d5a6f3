#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace abut {

/// Rows of coefficients over the nodes of a surface (compressed rows, columns ascending).
struct SparseRows {
  std::vector<std::int32_t> offsets;  // (rows + 1) where a row begins
  std::vector<std::int32_t> columns;  // nodes
  std::vector<double> values;         // their coefficients

  int count() const { return offsets.empty() ? 0 : static_cast<int>(offsets.size()) - 1; }
  /// No rows; memory is kept.
  void clear();
  /// Ends the row to which columns and values were added.
  void end_row() { offsets.push_back(static_cast<std::int32_t>(columns.size())); }
};

/// Adds the rows of another list over the same nodes.
void append(const SparseRows& more, SparseRows& rows);

/// out = rows x: from nodes (n, dim) to rows (r, dim), component by component.
void apply(const SparseRows& rows, int dim, std::span<const double> x, std::span<double> out);

/// out += factor rows^T f: from rows (r, dim) to nodes (n, dim), the adjoint of `apply`.
void add_transposed(const SparseRows& rows, int dim, double factor, std::span<const double> f,
                    std::span<double> out);

}  // namespace abut
