#include "coordinator/coupling/compare/dashpot_tie.hpp"

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
void take_in(const SurfaceRows& to, const SparseRows& seen, double factor, const SurfaceRows& from,
             std::int32_t first, int row, SparseRows& give) {
  for (auto e = seen.offsets[row]; e < seen.offsets[index(row) + 1]; ++e) {
    const auto at = std::ranges::lower_bound(from.nodes, seen.columns[e]);
    if (at == from.nodes.end() || *at != seen.columns[e]) continue;
    const std::size_t k = index(at - from.nodes.begin());
    give.columns.push_back(first + static_cast<std::int32_t>(k));
    give.values.push_back(factor * seen.values[e] * to.weights[row] / from.weights[k]);
  }
}

}  // namespace

/// What dashpots gave way in earlier windows stays.
void DashpotTie::begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) {
  start_.clear();
  Tie::begin(window, joint, bodies);
}

void DashpotTie::image(const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
                       const Bodies& bodies, Eigen::Ref<Eigen::VectorXd> g) {
  Tie::image(x, joint, bodies, g);
  const std::size_t width = index(iterate_.width);
  std::vector<double> impulse(width, 0.0), gives(width);
  for (int i = 1; i <= iterate_.steps.count; ++i) {
    const Eigen::Index at = iterate_.at(i);
    for (std::size_t k = 0; k < width; ++k) impulse[k] += iterate_.steps.step * x[at + k];
    apply(give_, rows_.dim, impulse, gives);
    for (std::size_t k = 0; k < width; ++k) {
      jump_[at + k] += gives[k];
      g[at + k] -= gives[k] / unit();
    }
  }
}

/// As much at the end of every later step as at that of the force's own.
void DashpotTie::give_way(int lag, int steps, const AddEntry& add) const {
  for (int k = 0; k < steps; ++k)
    for (int a = 0; a < (lag > 0 ? steps : k + 1); ++a)
      for (int v = 0; v < iterate_.width; ++v) {
        const int row = v / rows_.dim, d = v % rows_.dim;
        for (auto e = give_.offsets[row]; e < give_.offsets[row + 1]; ++e)
          add(k * iterate_.width + v, a * iterate_.width + give_.columns[e] * rows_.dim + d,
              iterate_.steps.step * give_.values[e]);
      }
}

std::unique_ptr<Tie> make_dashpot_tie(const PortGeometry& one, const PortGeometry& other,
                                      double impedance) {
  const SurfaceRows sides[] = {own_rows(one, other), own_rows(other, one)};
  TieRows rows;
  SparseRows give;
  rows.dim = one.dim;
  for (SparseRows* list : {&rows.of[0], &rows.of[1], &rows.force[0], &rows.force[1], &give})
    list->clear();
  const std::int32_t first[] = {0, sides[0].count()};
  for (const std::size_t s : {0u, 1u}) {
    const SurfaceRows &own = sides[s], &its = sides[1 - s];
    if (own.count() == 0) return std::make_unique<Tie>(TieRows());
    const double all = std::accumulate(own.weights.begin(), own.weights.end(), 0.0);
    for (int r = 0; r < own.count(); ++r) {
      rows.area.push_back(own.weights[r]);
      const double worth = all / (impedance * own.weights[r]);
      take_in(own, own.k, worth, own, first[s], r, give);
      take_in(own, own.n, -worth, its, first[1 - s], r, give);
      give.end_row();
      rows.force[1 - s].end_row();
    }
    append(own.k, rows.of[s]);
    append(own.k, rows.force[s]);
    append(own.n, rows.of[1 - s]);
  }
  return std::make_unique<DashpotTie>(std::move(rows), std::move(give));
}

}  // namespace abut
