#include "coordinator/body_hull.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "base/index.hpp"
#include "contract/whole_facets.hpp"
#include "surface/check.hpp"
#include "surface/inside.hpp"

namespace abut {

namespace {

using HullFacet = std::vector<std::int32_t>;

/// Facets of VTK's cells, corners first, then what lies on the edges in their order; those of
/// linear cells have the corners alone.
const std::vector<HullFacet>& facets_of(std::int32_t type) {
  static const std::vector<HullFacet> none;
  static const std::map<std::int32_t, std::vector<HullFacet>> all = [] {
    std::map<std::int32_t, std::vector<HullFacet>> of;
    of[22] = {{0, 1, 3}, {1, 2, 4}, {2, 0, 5}};
    of[23] = {{0, 1, 4}, {1, 2, 5}, {2, 3, 6}, {3, 0, 7}};
    of[24] = {{0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}, {0, 2, 1, 6, 5, 4}};
    of[25] = {{0, 1, 5, 4, 8, 17, 12, 16},  {1, 2, 6, 5, 9, 18, 13, 17},
              {2, 3, 7, 6, 10, 19, 14, 18}, {3, 0, 4, 7, 11, 16, 15, 19},
              {0, 3, 2, 1, 11, 10, 9, 8},   {4, 5, 6, 7, 12, 13, 14, 15}};
    for (const auto& [linear, second] : {std::pair{5, 22}, {9, 23}, {10, 24}, {12, 25}}) {
      for (const HullFacet& facet : of[second]) {
        const std::ptrdiff_t corners = facet.size() == 3 ? 2 : std::ssize(facet) / 2;
        of[linear].emplace_back(facet.begin(), facet.begin() + corners);
      }
    }
    return of;
  }();
  const auto found = all.find(type);
  return found == all.end() ? none : found->second;
}

int corners_of(int dim, std::size_t nodes) {
  if (dim == 2) return 2;
  return nodes == 3 || nodes == 6 ? 3 : 4;
}

/// Facets that belong to one cell alone, in the order of cells.
std::vector<HullFacet> outside_facets(const Grid& grid, int dim) {
  std::map<HullFacet, int> seen;  // by corners, sorted
  std::vector<std::pair<HullFacet, HullFacet>> all;
  for (std::size_t c = 0; c < grid.cells(); ++c) {
    const std::int32_t* nodes = grid.connectivity.data() + grid.offsets[c];
    for (const HullFacet& local : facets_of(grid.types[c])) {
      if (static_cast<int>(local.size()) < dim) continue;  // edges of a surface in space
      HullFacet facet;
      for (const std::int32_t node : local) facet.push_back(nodes[node]);
      HullFacet key(facet.begin(), facet.begin() + corners_of(dim, facet.size()));
      std::ranges::sort(key);
      ++seen[key];
      all.emplace_back(std::move(key), std::move(facet));
    }
  }
  std::vector<HullFacet> out;
  for (auto& [key, facet] : all)
    if (seen[key] == 1) out.push_back(std::move(facet));
  return out;
}

/// Of a quadrilateral in space; of others none.
Corners corners_of(const HullFacet& facet, const Grid& grid) {
  Corners corners;
  if (facet.size() != 4) return corners;
  for (const std::int32_t node : facet)
    corners.x[index(corners.count++)] =
        Eigen::Map<const Eigen::Vector3d>(&grid.points[3 * index(node)]);
  return corners;
}

/// Straight facets between all nodes of these, and the points that they need.
void add_facets(BodyHull& hull, const std::vector<HullFacet>& facets, const Grid& grid) {
  std::map<std::int32_t, std::int32_t> place;
  const auto number = [&](std::int32_t node) {
    const auto [at, fresh] = place.emplace(node, static_cast<std::int32_t>(hull.nodes.size()));
    if (fresh) {
      hull.nodes.push_back(node);
      for (int i = 0; i < hull.dim; ++i)
        hull.reference.push_back(grid.points[3 * index(node) + index(i)]);
    }
    return at->second;
  };
  for (const HullFacet& facet : facets) {
    const bool whole = facet.size() == 2 || (hull.dim == 3 && facet.size() <= 4);
    HullFacet every(facet.size());
    for (std::size_t i = 0; i < every.size(); ++i) every[i] = static_cast<std::int32_t>(i);
    const auto push = [&](const auto& part) {
      for (const auto i : part) hull.facets.push_back(number(facet[i]));
      hull.offsets.push_back(static_cast<std::int32_t>(hull.facets.size()));
    };
    if (const auto parts = unfolding(corners_of(facet, grid))) {
      for (const std::array<int, 3>& part : *parts) push(part);
    } else if (whole) {
      push(every);
    } else {
      for (const std::vector<int>& part : straight_parts(hull.dim, facet.size())) push(part);
    }
  }
}

/// In 1D: where the body begins and ends; a wall goes on behind its point.
BodyHull interval_of(const Description& body, const Grid& grid) {
  BodyHull hull;
  hull.dim = 1;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t n = 0; n < grid.nodes(); ++n) {
    hull.nodes.push_back(static_cast<std::int32_t>(n));
    hull.reference.push_back(grid.points[3 * n]);
    low = std::min(low, hull.reference.back());
    high = std::max(high, hull.reference.back());
  }
  if (hull.nodes.empty()) return {};
  hull.size = low < high ? (high - low) / static_cast<double>(grid.cells())
                         : std::numeric_limits<double>::infinity();
  if (low == high && !body.ports.empty())
    hull.endless = body.ports.front().geometry.normals.front() > 0.0 ? -1 : 1;
  return hull;
}

/// Of a port that encloses something, or else of the one with most facets.
BodyHull port_hull(const Description& body) {
  std::size_t port = body.ports.size(), most = 0;
  for (std::size_t p = 0; p < body.ports.size(); ++p) {
    const PortGeometry& g = body.ports[p].geometry;
    if (g.dim == 1 || g.offsets.size() <= 1) continue;
    const bool closed = is_closed(posed(g));
    if (!closed && g.offsets.size() <= most) continue;
    port = p;
    most = g.offsets.size();
    if (closed) break;
  }
  if (port == body.ports.size()) return {};
  const PortGeometry& g = body.ports[port].geometry;
  BodyHull hull;
  hull.dim = g.dim;
  hull.port = port;
  hull.reference = g.points;
  hull.facets = g.facets;
  hull.offsets = g.offsets;
  return hull;
}

/// Cells of a mirrored mesh tell their facets from the other side.
void look_outwards(BodyHull& hull) {
  const PosedSurface surface = hull.surface();
  double volume = 0.0;
  for (int f = 0; f < surface.facet_count(); ++f) {
    const Corners facet = corners(surface, f);
    volume += area(facet) * mean_normal(facet).dot(centre(facet));
  }
  if (volume >= 0.0) return;
  for (std::size_t f = 0; f + 1 < hull.offsets.size(); ++f)
    std::reverse(hull.facets.begin() + hull.offsets[f], hull.facets.begin() + hull.offsets[f + 1]);
}

/// Quadrilaterals begin where those of ports do, or across from there: contact divides them along
/// that diagonal, and what is warped is another surface along the other one.
void begin_as_ports(BodyHull& hull, const Description& body) {
  if (hull.dim != 3) return;
  using Place = std::array<double, 3>;
  const auto diagonal = [](const std::vector<double>& points, std::int32_t a, std::int32_t b) {
    std::array<Place, 2> ends{};
    std::copy_n(&points[3 * index(a)], 3, ends[0].begin());
    std::copy_n(&points[3 * index(b)], 3, ends[1].begin());
    return ends[1] < ends[0] ? std::array{ends[1], ends[0]} : ends;
  };
  std::set<std::array<Place, 2>> of_ports;
  for (const Port& port : body.ports) {
    const PortGeometry& g = port.geometry;
    for (std::size_t f = 0; g.dim == 3 && f + 1 < g.offsets.size(); ++f) {
      const std::int32_t* n = &g.facets[index(g.offsets[f])];
      if (g.offsets[f + 1] - g.offsets[f] == 4) of_ports.insert(diagonal(g.points, n[0], n[2]));
    }
  }
  for (std::size_t f = 0; f + 1 < hull.offsets.size(); ++f) {
    if (hull.offsets[f + 1] - hull.offsets[f] != 4) continue;
    std::int32_t* n = &hull.facets[index(hull.offsets[f])];
    if (of_ports.contains(diagonal(hull.reference, n[1], n[3]))) std::rotate(n, n + 1, n + 4);
  }
}

double typical_size(const PosedSurface& surface) {
  std::vector<double> sizes;
  for (int f = 0; f < surface.facet_count(); ++f) {
    const double whole = area(corners(surface, f));
    sizes.push_back(surface.dim == 2 ? whole : std::sqrt(whole));
  }
  if (sizes.empty()) return 0.0;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::ranges::nth_element(sizes, middle);
  return *middle;
}

}  // namespace

BodyHull hull_of(const Description& body, const Grid& grid) {
  if (body.dim == 1) return interval_of(body, grid);
  BodyHull hull;
  hull.dim = body.dim;
  hull.offsets = {0};
  add_facets(hull, outside_facets(grid, body.dim), grid);
  const bool of_cells = !hull.facets.empty();
  if (!of_cells) hull = port_hull(body);
  if (hull.dim == 0) return hull;
  pose(hull, {});
  if (of_cells) look_outwards(hull);
  if (of_cells) begin_as_ports(hull, body);
  hull.size = typical_size(hull.surface());
  return hull;
}

void pose(BodyHull& hull, std::span<const double> displacement) {
  const std::size_t dim = index(hull.dim);
  hull.points = hull.reference;
  for (std::size_t k = 0; k < hull.points.size() && !displacement.empty(); ++k) {
    const bool of_grid = !hull.nodes.empty();
    hull.points[k] += displacement[of_grid ? 3 * index(hull.nodes[k / dim]) + k % dim : k];
  }
  hull.box = {};
  for (std::size_t i = 0; i < dim; ++i) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t k = i; k < hull.points.size(); k += dim) {
      low = std::min(low, hull.points[k]);
      high = std::max(high, hull.points[k]);
    }
    hull.box.low[i] = hull.endless < 0 ? -std::numeric_limits<double>::infinity() : low;
    hull.box.high[i] = hull.endless > 0 ? std::numeric_limits<double>::infinity() : high;
  }
}

}  // namespace abut
