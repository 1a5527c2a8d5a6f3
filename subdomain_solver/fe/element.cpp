#include "subdomain_solver/fe/element.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/shape_functions.hpp"

namespace abut {
namespace {

using Facets = std::vector<std::vector<int>>;

template <std::size_t Corners, std::size_t Dim>
Element linear(std::string_view name, Shape shape, std::string_view facet_name,
               const Facets& facets, const std::array<std::array<double, Dim>, Corners>& corners,
               Evaluate evaluate) {
  Element element;
  element.name = name;
  element.shape = shape;
  element.dim = static_cast<int>(Dim);
  element.nodes = static_cast<int>(Corners);
  element.order = 1;
  element.facet_name = facet_name;
  element.facets = facets;
  for (const std::array<double, Dim>& corner : corners)
    element.corners.insert(element.corners.end(), corner.begin(), corner.end());
  element.evaluate = evaluate;
  return element;
}

/// The element with one more node on every edge, halfway. Facets have theirs in the order of the
/// facet's own edges, which go around its corners.
Element quadratic(std::string_view name, const Element& base, std::string_view facet_name,
                  std::span<const Edge> edges, Evaluate evaluate) {
  Element element = base;
  element.name = name;
  element.nodes = base.nodes + static_cast<int>(edges.size());
  element.order = 2;
  element.facet_name = facet_name;
  element.evaluate = evaluate;
  const auto dim = index(base.dim);
  for (const Edge& edge : edges) {
    for (std::size_t d = 0; d < dim; ++d) {
      const double from = base.corners[index(edge[0]) * dim + d];
      const double to = base.corners[index(edge[1]) * dim + d];
      element.corners.push_back(0.5 * (from + to));
    }
  }
  for (std::vector<int>& facet : element.facets) {
    const std::size_t corners = facet.size();
    const std::size_t sides = corners == 2 ? 1 : (corners == 1 ? 0 : corners);
    for (std::size_t k = 0; k < sides; ++k) {
      const Edge forth = {facet[k], facet[(k + 1) % corners]}, back = {forth[1], forth[0]};
      const auto found = std::find_if(edges.begin(), edges.end(), [forth, back](const Edge& edge) {
        return edge == forth || edge == back;
      });
      ABUT_ASSERT(found != edges.end());
      facet.push_back(base.nodes + static_cast<int>(found - edges.begin()));
    }
  }
  return element;
}

std::vector<Element> make_elements() {
  using enum Shape;
  const ShapeFunctions& n = shape_functions();
  Element single;
  single.name = "point1";
  single.nodes = 1;
  single.evaluate = n.point1;
  // Facets by their corners, in Exodus' order of sides; normals point outwards.
  const Facets line_facets = {{0}, {1}};
  const Facets triangle_facets = {{0, 1}, {1, 2}, {2, 0}};
  const Facets quadrilateral_facets = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  const Facets tetrahedron_facets = {{0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 2, 1}};
  const Facets hexahedron_facets = {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6},
                                    {0, 4, 7, 3}, {0, 3, 2, 1}, {4, 5, 6, 7}};
  const Element bar2 = linear("bar2", line, "point1", line_facets, cube_corners<1>(), n.bar2);
  const Element tri3 =
      linear("tri3", triangle, "bar2", triangle_facets, simplex_corners<2>(), n.tri3);
  const Element quad4 =
      linear("quad4", quadrilateral, "bar2", quadrilateral_facets, cube_corners<2>(), n.quad4);
  const Element tet4 =
      linear("tet4", tetrahedron, "tri3", tetrahedron_facets, simplex_corners<3>(), n.tet4);
  const Element hex8 =
      linear("hex8", hexahedron, "quad4", hexahedron_facets, cube_corners<3>(), n.hex8);
  return {single,
          bar2,
          quadratic("bar3", bar2, "point1", line_edges, n.bar3),
          tri3,
          quadratic("tri6", tri3, "bar3", triangle_edges, n.tri6),
          quad4,
          quadratic("quad8", quad4, "bar3", quadrilateral_edges, n.quad8),
          tet4,
          quadratic("tet10", tet4, "tri6", tetrahedron_edges, n.tet10),
          hex8,
          quadratic("hex20", hex8, "quad8", hexahedron_edges, n.hex20)};
}

bool simplex_or_line(const Element& element) {
  using enum Shape;
  return element.shape == line || element.shape == triangle || element.shape == tetrahedron;
}

}  // namespace

int Element::corner_count() const {
  switch (shape) {
    case Shape::point:
      return 1;
    case Shape::line:
      return 2;
    case Shape::triangle:
      return 3;
    case Shape::quadrilateral:
    case Shape::tetrahedron:
      return 4;
    case Shape::hexahedron:
      return 8;
  }
  return 0;
}

std::span<const Element> all_elements() {
  static const std::vector<Element> all = make_elements();
  return all;
}

const Element& element_named(std::string_view name) {
  std::string names;
  for (const Element& element : all_elements()) {
    if (element.name == name) return element;
    names += (names.empty() ? "" : ", ") + std::string(element.name);
  }
  throw InputError("is not an element: " + std::string(name), "", "Choose one of " + names + ".");
}

Tabulation tabulate(const Element& element, const Quadrature& rule) {
  Tabulation table;
  table.points = rule.count();
  table.nodes = element.nodes;
  table.dim = element.dim;
  table.weight = rule.weights;
  const auto points = index(table.points);
  const auto nodes = index(table.nodes);
  const auto dim = index(table.dim);
  ABUT_ASSERT(rule.points.size() == points * dim);
  table.n.resize(points * nodes);
  table.dn.resize(points * nodes * dim);
  for (std::size_t q = 0; q < points; ++q) {
    element.evaluate(std::span(rule.points).subspan(q * dim, dim),
                     std::span(table.n).subspan(q * nodes, nodes),
                     std::span(table.dn).subspan(q * nodes * dim, nodes * dim));
  }
  return table;
}

// On squares and cubes a derivative in one direction keeps the full degree in the others.
int stiffness_degree(const Element& element) {
  return 2 * (simplex_or_line(element) ? element.order - 1 : element.order);
}

int mass_degree(const Element& element) { return 2 * element.order; }

}  // namespace abut
