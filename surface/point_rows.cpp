#include "surface/point_rows.hpp"

#include <cmath>
#include <cstddef>
#include <optional>

#include "base/assert.hpp"
#include "surface/closest_point.hpp"
#include "surface/far_sides.hpp"

namespace abut {
namespace {

Eigen::Vector3d nodal(const PosedSurface& surface, std::span<const double> normals, int node) {
  return PosedSurface{surface.dim, normals, {}, {}}.point(node);
}

/// Whether x lies over the facet, or beside it by no more than the tolerance.
bool is_over(const Corners& facet, const Eigen::Vector3d& x, const SurfacePoint& foot, double rim) {
  if (foot.at.feature == FacetFeature::inside) return true;
  const Eigen::Vector3d way = x - foot.at.point, n = mean_normal(facet);
  const double size = facet.count == 2 ? area(facet) : std::sqrt(area(facet));
  return (way - way.dot(n) * n).norm() <= rim * size;
}

Eigen::Vector3d normal_at(const PosedSurface& n, const SurfacePoint& foot,
                          const PointRowOptions& options, std::span<const double> normals) {
  if (options.normal == RowNormal::facet) return mean_normal(corners(n, foot.facet));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int i = 0;
  for (std::int32_t node : n.nodes(foot.facet)) sum += foot.at.shape[i++] * nodal(n, normals, node);
  return sum.normalized();
}

/// One row: T = e_node, P by columns ascending.
void add_row(const PosedSurface& k, const PosedSurface& n, int node, const SurfacePoint& foot,
             const Eigen::Vector3d& normal, double weight, SurfaceRows& rows) {
  rows.nodes.push_back(node);
  rows.weights.push_back(weight);
  rows.normals.insert(rows.normals.end(), normal.data(), normal.data() + k.dim);
  rows.k.columns.push_back(node);
  rows.k.values.push_back(1.0);
  rows.k.end_row();
  const std::size_t begin = rows.n.columns.size();
  int i = 0;
  for (std::int32_t column : n.nodes(foot.facet)) {
    std::size_t at = rows.n.columns.size();
    while (at > begin && rows.n.columns[at - 1] > column) --at;
    const std::ptrdiff_t place = static_cast<std::ptrdiff_t>(at);
    rows.n.columns.insert(rows.n.columns.begin() + place, column);
    rows.n.values.insert(rows.n.values.begin() + place, foot.at.shape[i++]);
  }
  rows.n.end_row();
}

}  // namespace

void point_rows(const PosedSurface& k, std::span<const std::int32_t> nodes, const PosedSurface& n,
                const BoxTree& tree, const PointRowOptions& options, PointRowBuffers& buffers,
                SurfaceRows& rows) {
  ABUT_ASSERT(k.dim == n.dim);
  rows.clear();
  rows.dim = k.dim;
  nodal_normals(k, buffers.k_normals);
  if (options.normal == RowNormal::nodal) nodal_normals(n, buffers.n_normals);
  tributary_weights(k, buffers.weights);
  for (std::int32_t node : nodes) {
    const Eigen::Vector3d x = k.point(node);
    const ClosestSearch search{options.reach, nodal(k, buffers.k_normals, node), options.facing};
    const std::optional<SurfacePoint> foot = closest_point(n, tree, x, search);
    if (!foot || !is_over(corners(n, foot->facet), x, *foot, options.rim)) continue;
    if (sees_through(x, n, tree, foot->facet, options.thinnest)) continue;
    add_row(k, n, node, *foot, normal_at(n, *foot, options, buffers.n_normals),
            buffers.weights[node], rows);
  }
  rows.gaps.resize(rows.nodes.size());
  gaps(rows, k.points, n.points, rows.gaps);
}

}  // namespace abut
