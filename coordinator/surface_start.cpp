#include "coordinator/surface_start.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "surface/check.hpp"
#include "surface/divided_surface.hpp"
#include "surface/mortar.hpp"
#include "surface/point_rows.hpp"
#include "surface/sharp_nodes.hpp"

namespace abut {

namespace {

/// Of a facet's size: overlaps below it are roundings of the places.
constexpr double tolerance = 1.0e-6;

/// Facet sizes that a node may lie behind a surface and still be seen.
constexpr double reach = 2.0;

void check_facets(const NamedSurface& surface, const std::string& where) {
  const std::optional<UnsoundSurface> unsound = check(posed(surface.geometry));
  if (!unsound) return;
  throw InputError(fmt::format("{}: {}", surface.name, words(*unsound)), where,
                   "Mend the mesh there, or name another side.");
}

/// Nodes of `one` that lie behind the facets of `other`.
void check_nodes(const NamedSurface& one, const NamedSurface& other, const std::string& where) {
  const PosedSurface k = posed(one.geometry), n = posed(other.geometry);
  const double size = std::max(one.geometry.spacing, other.geometry.spacing);
  std::vector<std::int32_t> nodes(index(k.node_count()));
  std::iota(nodes.begin(), nodes.end(), 0);
  BoxTree tree;
  build(tree, n, reach * size);
  PointRowOptions options;
  options.reach = reach * size;
  PointRowBuffers buffers;
  SurfaceRows rows;
  point_rows(k, nodes, n, tree, options, buffers, rows);
  const auto deepest = std::ranges::min_element(rows.gaps);
  if (deepest == rows.gaps.end() || *deepest >= -tolerance * size) return;
  const std::size_t node = index(rows.nodes[index(deepest - rows.gaps.begin())]);
  const std::size_t dim = index(k.dim);
  const std::span<const double> at = k.points.subspan(node * dim, dim);
  throw InputError(
      fmt::format("its sides overlap by {:.3g} m at the start: a node of {} at ({:.6g}) "
                  "m lies behind {}",
                  -*deepest, one.name, fmt::join(at, ", "), other.name),
      where, "Move a body with initial.position until they are apart.");
}

bool has_edges(const NamedSurface& surface) {
  return !sharp_nodes(posed(surface.geometry), sharp_edge).empty();
}

/// Rows will be of the nodes of the surface that has edges, divided as finely as the finder's
/// (METHOD.md, [M.93]).
void check_division(const NamedSurface& finder, const NamedSurface& edged,
                    const std::string& where) {
  constexpr double most_facets = 2.0e5;
  const PosedSurface surface = posed(edged.geometry);
  const double parts = parts_for(surface, finder.geometry.spacing);
  const double facets = surface.facet_count() * std::pow(parts, surface.dim - 1);
  if (facets <= most_facets) return;
  throw InputError(
      fmt::format("{} has sharp edges and is to be divided as finely as {}, {:.3g} m, which makes "
                  "{:.3g} facets of it",
                  edged.name, finder.name, finder.geometry.spacing, facets),
      where,
      fmt::format("Name a side of {} without edges, or make the body no larger than what it "
                  "touches.",
                  edged.name));
}

/// Facets of polygons that stand for round bodies overlap on the average of a node's surroundings
/// before any node does: contact would begin with a blow.
void check_averages(const NamedSurface& one, const NamedSurface& other, const std::string& where) {
  const PosedSurface k = posed(one.geometry), n = posed(other.geometry);
  const double size = std::max(one.geometry.spacing, other.geometry.spacing);
  BoxTree own, its;
  build(own, k, 0.0);
  build(its, n, size);
  std::vector<FacetPair> pairs;
  overlapping_pairs(own, its, pairs);
  MortarOptions options;
  options.reach = one.geometry.spacing;
  MortarBuffers buffers;
  SurfaceRows rows;
  mortar_rows(k, n, pairs, options, buffers, rows);
  const auto deepest = std::ranges::min_element(rows.gaps);
  if (deepest == rows.gaps.end() || *deepest >= -tolerance * size) return;
  throw InputError(fmt::format("its sides are too near at the start: over the width of a facet {} "
                               "overlaps {} by {:.3g} m, though no node does",
                               one.name, other.name, -*deepest),
                   where,
                   fmt::format("Move a body with initial.position by {:.3g} m more, or make the "
                               "mesh finer.",
                               -*deepest));
}

}  // namespace

void check_surfaces(const NamedSurface& finder, const NamedSurface& other,
                    const std::string& where) {
  check_facets(finder, where);
  check_facets(other, where);
  check_nodes(finder, other, where);
  check_nodes(other, finder, where);
  const bool turned = has_edges(other) && !has_edges(finder);
  if (turned) check_division(finder, other, where);
  check_averages(turned ? other : finder, turned ? finder : other, where);
}

}  // namespace abut
