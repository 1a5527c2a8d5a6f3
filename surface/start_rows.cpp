#include "surface/start_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "base/index.hpp"
#include "surface/closest_point.hpp"
#include "surface/far_sides.hpp"
#include "surface/meeting_corners.hpp"
#include "surface/mortar.hpp"
#include "surface/point_rows.hpp"
#include "surface/sharp_nodes.hpp"

namespace abut {

namespace {

/// Facet sizes that a node may lie behind a surface and still be seen.
constexpr double reach = 2.0;
/// Of the size of facets: what is no farther beside one lies over it.
constexpr double lies_over = 0.02;
/// Of the size of facets: bodies are not thinner.
constexpr double thinnest = 1.0e-3;

/// Half of sharp_edge: the angle between a facet and the normal of its node where two such meet.
const double smooth = std::cos(0.5 * sharp_edge);

/// [m] How near the other surface edges are that its facets see and that lie over it, no farther
/// off than a facet; infinity: none is.
double nearest_edge(const StartSurface& one, const StartSurface& other) {
  double least = std::numeric_limits<double>::infinity();
  const std::vector<std::int32_t> nodes = edge_nodes(one.surface, other.spacing);
  if (nodes.empty()) return least;
  BoxTree tree;
  build(tree, other.surface, 0.0);
  ClosestSearch search;
  search.reach = facet_size(one, other);
  for (const std::int32_t node : nodes) {
    const Eigen::Vector3d x = one.surface.point(node);
    const auto foot = closest_point(other.surface, tree, x, search);
    if (!foot) continue;
    const Eigen::Vector3d way = x - foot->at.point;
    const Eigen::Vector3d normal = mean_normal(corners(other.surface, foot->facet));
    if ((way - way.dot(normal) * normal).norm() <= lies_over * other.spacing)
      least = std::min(least, foot->at.distance);
  }
  return least;
}

}  // namespace

double facet_size(const StartSurface& one, const StartSurface& other) {
  return std::max(one.spacing, other.spacing);
}

double sag(const PosedSurface& surface) {
  std::vector<double> normals;
  nodal_normals(surface, normals);
  const PosedSurface at_nodes{surface.dim, normals, {}, {}};
  double most = 0.0;
  for (int f = 0; f < surface.facet_count(); ++f) {
    const Eigen::Vector3d whole = mean_normal(corners(surface, f));
    for (const std::int32_t a : surface.nodes(f)) {
      const Eigen::Vector3d n = at_nodes.point(a);
      if (n.dot(whole) < smooth) continue;
      for (const std::int32_t b : surface.nodes(f))
        most = std::max(most, std::abs(n.dot(surface.point(b) - surface.point(a))));
    }
  }
  return 0.5 * most;
}

double roundness(const StartSurface& one, const StartSurface& other) {
  return sag(one.surface) + sag(other.surface);
}

SurfaceRows node_rows(const StartSurface& one, const StartSurface& other) {
  std::vector<std::int32_t> nodes(index(one.surface.node_count()));
  std::iota(nodes.begin(), nodes.end(), 0);
  PointRowOptions options;
  options.reach = reach * facet_size(one, other);
  options.thinnest = thinnest * one.spacing;
  BoxTree tree;
  build(tree, other.surface, options.reach);
  PointRowBuffers buffers;
  SurfaceRows rows;
  point_rows(one.surface, nodes, other.surface, tree, options, buffers, rows);
  return rows;
}

SurfaceRows average_rows(const StartSurface& one, const StartSurface& other) {
  BoxTree own, its;
  build(own, one.surface, 0.0);
  build(its, other.surface, facet_size(one, other));
  std::vector<FacetPair> pairs;
  overlapping_pairs(own, its, pairs);
  FarSides().leave_out(one.surface, other.surface, thinnest * one.spacing, pairs);
  MortarOptions options;
  options.reach = one.spacing;
  MeetingCorners corners;
  const Wedges wedges(one.surface), its_wedges(other.surface);
  corners.find({one.surface, one.surface, &wedges}, {other.surface, other.surface, &its_wedges},
               pairs, {options.facing, 0.0});
  std::erase_if(pairs, [&corners](const FacetPair& pair) { return corners.drops(pair); });
  MortarBuffers buffers;
  SurfaceRows rows;
  mortar_rows(one.surface, other.surface, pairs, options, buffers, rows);
  corners.join(rows);
  return rows;
}

bool has_edges(const PosedSurface& surface) { return !sharp_nodes(surface, sharp_edge).empty(); }

bool rows_of_other(const StartSurface& finder, const StartSurface& other) {
  return nearest_edge(other, finder) + lies_over * finder.spacing < nearest_edge(finder, other);
}

}  // namespace abut
