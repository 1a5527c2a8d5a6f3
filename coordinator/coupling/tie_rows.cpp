#include "coordinator/coupling/tie_rows.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "coordinator/coupling/twin_nodes.hpp"
#include "surface/mortar.hpp"

namespace abut {

namespace {

/// Of the coarser facets: farther apart they do not belong together.
constexpr double reach = 1.0;

SparseRows one_point() { return {{0, 1}, {0}, {1.0}}; }

TieRows of_points(const PortGeometry& one, const PortGeometry& other) {
  TieRows rows;
  rows.of = {one_point(), one_point()};
  rows.area = {1.0};
  rows.apart = std::abs(one.points[0] - other.points[0]);
  rows.place = {one.points[0]};
  return rows;
}

/// One row per node and its twin: what the dual rows of flat faces are where nodes meet, and what
/// keeps folded faces of any shape whole.
void of_twins(const std::vector<std::int32_t>& twins, SparseRows& k, SparseRows& n) {
  k.offsets = n.offsets = {0};
  for (std::size_t node = 0; node < twins.size(); ++node) {
    k.columns.push_back(static_cast<std::int32_t>(node));
    n.columns.push_back(twins[node]);
    for (SparseRows* rows : {&k, &n}) {
      rows->values.push_back(1.0);
      rows->end_row();
    }
  }
}

/// Where gaps are largest.
void see_gaps(const SurfaceRows& found, const PosedSurface& k, TieRows& rows) {
  std::size_t most = 0;
  for (std::size_t r = 0; r < found.gaps.size(); ++r)
    if (std::abs(found.gaps[r]) > std::abs(found.gaps[most])) most = r;
  rows.apart = std::abs(found.gaps[most]);
  const Eigen::Vector3d at = k.point(found.nodes[most]);
  rows.place.assign(at.data(), at.data() + rows.dim);
}

}  // namespace

TieRows make_tie_rows(const PortGeometry& one, const PortGeometry& other, int side) {
  if (one.dim == 1) return of_points(one, other);
  const bool first = side == 0;  // has the rows
  const PosedSurface k = posed(first ? one : other), n = posed(first ? other : one);
  TieRows rows;
  rows.dim = one.dim;
  if (const std::vector<std::int32_t> twins = twin_nodes(k, n); !twins.empty()) {
    of_twins(twins, rows.of[first ? 0 : 1], rows.of[first ? 1 : 0]);
    tributary_weights(k, rows.area);
    rows.place.assign(one.points.begin(), one.points.begin() + one.dim);
    return rows;
  }
  const double far = reach * std::max(one.spacing, other.spacing);
  BoxTree of_k, of_n;
  build(of_k, k, far);
  build(of_n, n, far);
  std::vector<FacetPair> pairs;
  overlapping_pairs(of_k, of_n, pairs);
  MortarOptions options;
  options.reach = far;
  MortarBuffers buffers;
  SurfaceRows found;
  mortar_rows(k, n, pairs, options, buffers, found);
  if (found.count() == 0) return rows;
  see_gaps(found, k, rows);
  rows.of[first ? 0 : 1] = std::move(found.k);
  rows.of[first ? 1 : 0] = std::move(found.n);
  rows.area = std::move(found.weights);
  return rows;
}

}  // namespace abut
