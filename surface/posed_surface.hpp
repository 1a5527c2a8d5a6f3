#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/index.hpp"

namespace abut {

/// A surface in one pose: a view, nothing is owned. Facets are segments in the plane, triangles and
/// bilinear quadrilaterals in space. Their connectivity orients them: in the plane the body lies to
/// the left of a segment, in space nodes turn counterclockwise for who looks at the body.
struct PosedSurface {
  int dim = 3;                            // 2 or 3
  std::span<const double> points;         // [m] (n, dim)
  std::span<const std::int32_t> facets;   // nodes of the facets, one facet after the other
  std::span<const std::int32_t> offsets;  // (m + 1) where a facet begins in `facets`; from 0
  bool round = false;  // in the plane: facets are rings about x = 0, and weigh by 2 pi x

  int node_count() const { return static_cast<int>(points.size()) / dim; }
  int facet_count() const { return offsets.empty() ? 0 : static_cast<int>(offsets.size()) - 1; }
  std::span<const std::int32_t> nodes(int facet) const {
    const std::size_t begin = index(offsets[facet]);
    return facets.subspan(begin, index(offsets[facet + 1]) - begin);
  }
  /// [m] three components always, so that one code serves plane and space: the plane is z = 0.
  Eigen::Vector3d point(int node) const {
    const double* x = points.data() + static_cast<std::ptrdiff_t>(dim) * node;
    return {x[0], x[1], dim == 3 ? x[2] : 0.0};
  }
};

/// A pose, of its own points or of others [m] (n, dim), of whatever has the facets of a surface.
template <class Surface>
PosedSurface posed(const Surface& surface, std::span<const double> points) {
  return {surface.dim, points, surface.facets, surface.offsets, surface.round};
}
template <class Surface>
PosedSurface posed(const Surface& surface) {
  return posed(surface, surface.points);
}

/// The corners of one facet. No facet has more than four.
struct Corners {
  int count = 0;
  std::array<Eigen::Vector3d, 4> x;  // [m]
};

inline Corners corners(const PosedSurface& surface, int facet) {
  Corners c;
  for (std::int32_t node : surface.nodes(facet)) c.x[c.count++] = surface.point(node);
  return c;
}

/// [m] mean of the corners.
inline Eigen::Vector3d centre(const Corners& c) {
  Eigen::Vector3d sum = c.x[0] + c.x[1];
  for (int i = 2; i < c.count; ++i) sum += c.x[i];
  return sum / c.count;
}

/// [m^(dim-1)] integral of the outward normal over the facet: what a unit pressure leaves behind.
/// Exact for warped quadrilaterals too.
inline Eigen::Vector3d area_vector(const Corners& c) {
  if (c.count == 2) {
    const Eigen::Vector3d t = c.x[1] - c.x[0];
    return {t.y(), -t.x(), 0.0};
  }
  if (c.count == 3) return 0.5 * (c.x[1] - c.x[0]).cross(c.x[2] - c.x[0]);
  return 0.5 * (c.x[2] - c.x[0]).cross(c.x[3] - c.x[1]);
}

/// [m^(dim-1)] length of a segment, area of a triangle, of a quadrilateral the area that it shows
/// along its mean normal.
inline double area(const Corners& c) { return area_vector(c).norm(); }

/// Mean outward unit normal; zero for a facet without area, which therefore faces nothing.
inline Eigen::Vector3d mean_normal(const Corners& c) {
  const Eigen::Vector3d a = area_vector(c);
  const double size = a.norm();
  return size > 0.0 ? Eigen::Vector3d(a / size) : Eigen::Vector3d::Zero();
}

/// [m] of all facets; 0 without one.
double longest_edge(const PosedSurface& surface);

/// Outward unit normals at the nodes, (n, dim): facets by area. Zero at a node without facets.
void nodal_normals(const PosedSurface& surface, std::vector<double>& normals);

/// [m^(dim-1)] Integrals of a facet's N_j, of which it has as many as nodes, in its mean plane:
/// exact, closed form. Of round surfaces [m^2], of whole rings.
std::array<double, 4> facet_weights(const PosedSurface& surface, int f);

/// [m^(dim-1)] (n) w_j = sum over the facets of the integral of N_j, in the facets' mean planes:
/// exact, closed form. Of round surfaces [m^2], of whole rings.
void tributary_weights(const PosedSurface& surface, std::vector<double>& weights);

}  // namespace abut
