#include "surface/posed_surface.hpp"

#include <algorithm>
#include <numbers>

#include "base/index.hpp"

namespace abut {

double longest_edge(const PosedSurface& surface) {
  double longest = 0.0;
  for (int f = 0; f < surface.facet_count(); ++f) {
    const Corners c = corners(surface, f);
    for (int i = 0; i < c.count; ++i)
      longest = std::max(longest, (c.x[(i + 1) % c.count] - c.x[i]).norm());
  }
  return longest;
}

void nodal_normals(const PosedSurface& surface, std::vector<double>& normals) {
  const int dim = surface.dim;
  normals.assign(surface.points.size(), 0.0);
  for (int f = 0; f < surface.facet_count(); ++f) {
    const Eigen::Vector3d a = area_vector(corners(surface, f));
    for (std::int32_t node : surface.nodes(f))
      for (int d = 0; d < dim; ++d) normals[dim * node + d] += a[d];
  }
  for (int node = 0; node < surface.node_count(); ++node) {
    Eigen::Map<Eigen::VectorXd> n(normals.data() + dim * node, dim);
    const double size = n.norm();
    if (size > 0.0) n /= size;
  }
}

std::array<double, 4> facet_weights(const PosedSurface& surface, int f) {
  const Corners c = corners(surface, f);
  if (surface.round) {
    const double r0 = c.x[0].x(), r1 = c.x[1].x(), ring = std::numbers::pi / 3.0 * area(c);
    return {ring * (2.0 * r0 + r1), ring * (r0 + 2.0 * r1)};
  }
  std::array<double, 4> weights{};
  if (c.count < 4) {
    std::fill_n(weights.begin(), c.count, area(c) / c.count);
    return weights;
  }
  // x = c0 + ca a + cb b + cab a b; its Jacobian along the mean normal is j0 + ja a + jb b, and
  // the integral of N_i = (1 + s a)(1 + t b) / 4 times that over [-1, 1]^2 is j0 + (s ja + t
  // jb)/3
  const Eigen::Vector3d ca = 0.25 * (-c.x[0] + c.x[1] + c.x[2] - c.x[3]);
  const Eigen::Vector3d cb = 0.25 * (-c.x[0] - c.x[1] + c.x[2] + c.x[3]);
  const Eigen::Vector3d cab = 0.25 * (c.x[0] - c.x[1] + c.x[2] - c.x[3]);
  const Eigen::Vector3d n = mean_normal(c);
  const double j0 = ca.cross(cb).dot(n);
  const double ja = ca.cross(cab).dot(n) / 3.0, jb = cab.cross(cb).dot(n) / 3.0;
  return {j0 - ja - jb, j0 + ja - jb, j0 + ja + jb, j0 - ja + jb};
}

void tributary_weights(const PosedSurface& surface, std::vector<double>& weights) {
  weights.assign(index(surface.node_count()), 0.0);
  for (int f = 0; f < surface.facet_count(); ++f) {
    const std::array<double, 4> parts = facet_weights(surface, f);
    const std::span<const std::int32_t> nodes = surface.nodes(f);
    for (std::size_t i = 0; i < nodes.size(); ++i) weights[index(nodes[i])] += parts[i];
  }
}

}  // namespace abut
