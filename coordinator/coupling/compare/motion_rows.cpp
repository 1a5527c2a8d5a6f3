#include "coordinator/coupling/compare/motion_rows.hpp"

namespace abut {

namespace {

/// Without what is inside a body.
SparseRows of_side(const SparseRows& rows, const PortGeometry& port) {
  SparseRows own;
  own.clear();
  for (int r = 0; r < rows.count(); ++r) {
    for (auto e = rows.offsets[r]; e < rows.offsets[r + 1]; ++e) {
      if (rows.columns[e] >= port.count() - port.embedded) continue;
      own.columns.push_back(rows.columns[e]);
      own.values.push_back(rows.values[e]);
    }
    own.end_row();
  }
  return own;
}

}  // namespace

TieRows make_motion_rows(const PortGeometry& one, const PortGeometry& other) {
  TieRows rows = make_overlap_rows(one, other);
  rows.force = {of_side(rows.of[0], one), of_side(rows.of[1], other)};
  return rows;
}

}  // namespace abut
