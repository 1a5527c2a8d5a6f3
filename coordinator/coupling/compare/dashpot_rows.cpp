#include "coordinator/coupling/compare/dashpot_rows.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "surface/mortar.hpp"

namespace abut {

namespace {

/// Of one side against the other: rows of its own shape functions, not of dual ones, whose
/// projections lengthen nothing, so that dashpots only take.
SurfaceRows own_rows(const PortGeometry& own, const PortGeometry& other) {
  SurfaceRows rows;
  rows.dim = own.dim;
  if (own.dim == 1) {
    rows.nodes = {0};
    rows.weights = {1.0};
    rows.k = rows.n = {{0, 1}, {0}, {1.0}};
    return rows;
  }
  const PosedSurface k = posed(own), n = posed(other);
  MortarOptions options;
  options.reach = std::max(own.spacing, other.spacing);
  options.merge = 0.0;
  options.dual_from = std::numeric_limits<double>::infinity();
  BoxTree of_k, of_n;
  build(of_k, k, options.reach);
  build(of_n, n, options.reach);
  std::vector<FacetPair> pairs;
  overlapping_pairs(of_k, of_n, pairs);
  MortarBuffers buffers;
  mortar_rows(k, n, pairs, options, buffers, rows);
  return rows;
}

/// Forces of `from`, one per node of its side, as `to` sees them: weights of both are areas, their
/// quotients with forces tractions.
void take_in(const SurfaceRows& to, const SparseRows& seen, double sign, const SurfaceRows& from,
             std::int32_t first, int row, SparseRows& incoming) {
  for (auto e = seen.offsets[row]; e < seen.offsets[index(row) + 1]; ++e) {
    const auto at = std::ranges::lower_bound(from.nodes, seen.columns[e]);
    if (at == from.nodes.end() || *at != seen.columns[e]) continue;
    const std::size_t k = index(at - from.nodes.begin());
    incoming.columns.push_back(first + static_cast<std::int32_t>(k));
    incoming.values.push_back(sign * seen.values[e] * to.weights[row] / from.weights[k]);
  }
}

}  // namespace

TieRows make_dashpot_rows(const PortGeometry& one, const PortGeometry& other, double impedance) {
  const SurfaceRows sides[] = {own_rows(one, other), own_rows(other, one)};
  TieRows rows;
  rows.dim = one.dim;
  for (SparseRows* list : {&rows.of[0], &rows.of[1], &rows.incoming}) list->clear();
  const std::int32_t first[] = {0, sides[0].count()};
  for (const std::size_t s : {0u, 1u}) {
    const SurfaceRows &own = sides[s], &its = sides[1 - s];
    if (own.count() == 0) return {};
    const double all = std::accumulate(own.weights.begin(), own.weights.end(), 0.0);
    for (int r = 0; r < own.count(); ++r) {
      rows.moves.push_back(static_cast<std::int8_t>(s));
      rows.area.push_back(own.weights[r]);
      rows.dashpots.push_back(impedance * own.weights[r] / all);
      take_in(own, own.k, 1.0, own, first[s], r, rows.incoming);
      take_in(own, own.n, -1.0, its, first[1 - s], r, rows.incoming);
      rows.incoming.end_row();
    }
    append(own.k, rows.of[s]);
    append(own.n, rows.of[1 - s]);
  }
  return rows;
}

}  // namespace abut
