#include "coordinator/coupling/row_margin.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"

namespace abut {

namespace {

struct FacetSize {
  double rise = 0.0;          // [m] out of the tangent planes at their nodes, at most
  double reach_square = 0.0;  // [m^2] of the longest way between nodes of one
};

FacetSize facet_size_of(const PortGeometry& surface) {
  const std::size_t dim = index(surface.dim);
  FacetSize facets;
  for (std::size_t f = 0; f + 1 < surface.offsets.size(); ++f) {
    const std::size_t begin = index(surface.offsets[f]), end = index(surface.offsets[f + 1]);
    for (std::size_t a = begin; a < end; ++a) {
      for (std::size_t b = begin; b < end; ++b) {
        double off = 0.0, square = 0.0;
        for (std::size_t i = 0; i < dim; ++i) {
          const double way = surface.points[index(surface.facets[b]) * dim + i] -
                             surface.points[index(surface.facets[a]) * dim + i];
          off += surface.normals[index(surface.facets[a]) * dim + i] * way;
          square += way * way;
        }
        facets.rise = std::max(facets.rise, std::abs(off));
        facets.reach_square = std::max(facets.reach_square, square);
      }
    }
  }
  return facets;
}

/// [m] by which rows see a side nearer than its facets are. A dual row of facets of length h of a
/// flat side takes the rise k h^2/2 of the other's curvature k for -k h^2/12: a sixth. Half as much
/// again is added, for meshes that are not uniform.
double early(const FacetSize& curved, const FacetSize& rows) {
  if (curved.rise == 0.0) return 0.0;
  return 0.25 * curved.rise * std::max(1.0, rows.reach_square / curved.reach_square);
}

}  // namespace

double row_margin(const std::array<Side, 2>& sides, const Bodies& bodies) {
  const std::array<FacetSize, 2> facets = {facet_size_of(bodies.port(sides[0]).geometry),
                                           facet_size_of(bodies.port(sides[1]).geometry)};
  double margin = 0.0;
  for (std::size_t s : {0u, 1u}) {  // rows are of sides that take obstacles
    const bool finds = bodies.describe(sides[s].body).can.obstacle;
    margin += early(facets[1 - s], finds ? facets[s] : facets[1 - s]);
  }
  return margin;
}

double row_margin_of_all(std::span<const Side> surfaces, const Bodies& bodies) {
  std::vector<FacetSize> all;
  FacetSize rows;
  for (const Side& side : surfaces) {
    all.push_back(facet_size_of(bodies.port(side).geometry));
    if (bodies.describe(side.body).can.obstacle)
      rows.reach_square = std::max(rows.reach_square, all.back().reach_square);
  }
  double most = 0.0;
  for (const FacetSize& curved : all) most = std::max(most, early(curved, rows));
  return 2.0 * most;
}

}  // namespace abut
