#include "subdomain_solver/port_geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/index.hpp"
#include "contract/whole_facets.hpp"
#include "subdomain_solver/fe/loads.hpp"
#include "surface/check.hpp"

namespace abut {

namespace {

/// A quadrilateral that is not convex makes two facets, which rows can be made of.
bool add_divided(const std::vector<std::int32_t>& places, PortGeometry& geometry) {
  if (geometry.dim != 3 || places.size() != 4) return false;
  Corners corners{4, {}};
  for (std::size_t i = 0; i < 4; ++i)
    corners.x[i] = Eigen::Map<const Eigen::Vector3d>(&geometry.points[3 * index(places[i])]);
  const auto parts = unfolding(corners);
  if (!parts) return false;
  for (const std::array<int, 3>& part : *parts) {
    for (const int local : part) geometry.facets.push_back(places[index(local)]);
    geometry.offsets.push_back(static_cast<std::int32_t>(geometry.facets.size()));
    geometry.parts.push_back(1);
  }
  return true;
}

void add_parts(int dim, const std::vector<std::int32_t>& places, PortGeometry& geometry) {
  if (add_divided(places, geometry)) return;
  const std::vector<std::vector<int>>& parts = straight_parts(dim, places.size());
  for (const std::vector<int>& part : parts) {
    for (const int local : part) geometry.facets.push_back(places[local]);
    geometry.offsets.push_back(static_cast<std::int32_t>(geometry.facets.size()));
  }
  geometry.parts.push_back(static_cast<std::int32_t>(parts.size()));
}

/// Of a node's shape function in the mean of normals that are to look outward. Those of second
/// order have no area at the corners of a triangle, and a negative one at those of a quadrilateral.
double share(double shape, std::size_t nodes, int dim) {
  const bool first_order = dim == 2 ? nodes == 2 : nodes <= 4;
  return first_order ? shape : 1.0;
}

/// Facets on the axis of a body of revolution make no ring and have no area: their nodes look as
/// they do in the plane.
void add_on_axis(PortGeometry& geometry) {
  if (!geometry.round || geometry.facets.empty()) return;
  std::vector<double> in_plane;
  nodal_normals(posed(geometry), in_plane);
  for (std::size_t k = 0; k < in_plane.size(); k += 2)
    if (geometry.normals[k] == 0.0 && geometry.normals[k + 1] == 0.0)
      std::copy_n(in_plane.begin() + static_cast<std::ptrdiff_t>(k), 2,
                  geometry.normals.begin() + static_cast<std::ptrdiff_t>(k));
}

void normalise(std::vector<double>& normals, std::size_t dim) {
  for (std::size_t k = 0; k < normals.size(); k += dim) {
    double length = 0.0;
    for (std::size_t i = 0; i < dim; ++i) length = std::hypot(length, normals[k + i]);
    for (std::size_t i = 0; i < dim && length > 0.0; ++i) normals[k + i] /= length;
  }
}

}  // namespace

PortGeometry port_geometry(const FeModel& model, const std::string& name,
                           const std::vector<std::int32_t>& nodes) {
  const Mesh& mesh = model.mesh();
  const std::size_t dim = index(mesh.dim);
  PortGeometry geometry;
  geometry.dim = mesh.dim;
  geometry.round = model.round();
  for (std::int32_t node : nodes) {
    const double* x = mesh.points.data() + index(node) * dim;
    geometry.points.insert(geometry.points.end(), x, x + dim);
  }
  geometry.normals.assign(nodes.size() * dim, 0.0);
  if (!mesh.sides.contains(name)) return geometry;
  std::vector<double>& normals = geometry.normals;
  if (dim > 1) geometry.offsets.push_back(0);
  double size = 0.0;
  std::vector<std::int32_t> places;
  const SidePoints side = SidePoints::of(model, name);
  for (const SidePoints::FacetPoints& facet : side.facets) {
    places.clear();
    for (std::size_t a = 0; a < facet.nodes.size(); ++a) {
      const auto place = std::ranges::lower_bound(nodes, facet.nodes[a]) - nodes.begin();
      places.push_back(static_cast<std::int32_t>(place));
      for (const SidePoints::Point& point : facet.points) {
        for (std::size_t i = 0; i < dim; ++i)
          normals[index(place) * dim + i] += point.area *
                                             share(point.n[a], facet.nodes.size(), mesh.dim) *
                                             point.normal(static_cast<Eigen::Index>(i));
      }
    }
    if (dim > 1) add_parts(mesh.dim, places, geometry);
    for (const SidePoints::Point& point : facet.points) size += point.size;
  }
  add_on_axis(geometry);
  normalise(normals, dim);
  if (std::ranges::all_of(geometry.parts, [](std::int32_t parts) { return parts == 1; }))
    geometry.parts.clear();
  if (dim == 1) {
    const Facet& end = mesh.side(name).front();
    const CellBlock& cells = mesh.blocks[end.block];
    const std::int32_t* cell = cells.nodes.data() + end.cell * cells.element->nodes;
    geometry.spacing = mesh.points[cell[1]] - mesh.points[cell[0]];
    return geometry;
  }
  const double facets = static_cast<double>(std::max<std::size_t>(1, side.facets.size()));
  geometry.spacing = std::pow(size / facets, 1.0 / std::max(1.0, static_cast<double>(dim) - 1.0));
  return geometry;
}

}  // namespace abut
