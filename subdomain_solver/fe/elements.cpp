// The table of elements: whatever depends on an element's name stands here, one entry per element.

#include <algorithm>
#include <cstddef>
#include <utility>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/element.hpp"
#include "subdomain_solver/fe/shape_functions.hpp"

namespace abut {
namespace {

using Lists = std::vector<std::vector<int>>;

/// What elements of one shape share. Facets by their corners, in Exodus' order of sides; normals
/// point outwards.
struct Corners {
  int dim = 0;
  std::vector<double> places;  // (corners, dim)
  Lists facets;
};

template <class Places>
std::vector<double> flat(const Places& corners) {
  std::vector<double> all;
  for (const auto& corner : corners) all.insert(all.end(), corner.begin(), corner.end());
  return all;
}

Corners corners_of(Shape shape) {
  switch (shape) {
    case Shape::point:
      break;
    case Shape::line:
      return {1, flat(cube_corners<1>()), {{0}, {1}}};
    case Shape::triangle:
      return {2, flat(simplex_corners<2>()), {{0, 1}, {1, 2}, {2, 0}}};
    case Shape::quadrilateral:
      return {2, flat(cube_corners<2>()), {{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
    case Shape::tetrahedron:
      return {3, flat(simplex_corners<3>()), {{0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 2, 1}}};
    case Shape::hexahedron:
      return {3,
              flat(cube_corners<3>()),
              {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}, {0, 3, 2, 1}, {4, 5, 6, 7}}};
  }
  return {};
}

/// One element. The rest of `Element` follows from this and from its facets' element.
struct Entry {
  std::string_view name;
  Shape shape;
  Evaluate evaluate;
  int gmsh;
  std::int32_t vtk;
  std::string_view facet_name = "";  // stands above in the table
  Lists between = {};
  std::vector<int> vtk_nodes = {}, exodus_nodes = {};
};

template <class Edges>
Lists on(const Edges& edges) {
  Lists lists;
  for (const Edge& edge : edges) lists.emplace_back(edge.begin(), edge.end());
  return lists;
}

/// Elements of one shape: the linear one first. Choices are listed in this order.
std::vector<Entry> entries() {
  using enum Shape;
  const ShapeFunctions& n = shape_functions();
  // Gmsh's numbers: "Node ordering" and "MSH file format" of its manual. VTK's: vtkCellType.h and
  // the classes of the cells; it goes around the base, then up (tet10 01 12 20 03 13 23; hex20
  // around the lower face, the upper one, and the edges between them). Exodus': SAND92-2137, 4.8.
  const std::vector<int> tet10 = {0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
  Lists quad9 = on(quadrilateral_edges);
  quad9.push_back({0, 1, 2, 3});
  return {
      {"point1", point, n.point1, 15, 1},
      {"bar2", line, n.bar2, 1, 3, "point1"},
      {"bar3", line, n.bar3, 8, 21, "point1", on(line_edges)},
      {"quad4", quadrilateral, n.quad4, 3, 9, "bar2"},
      {"quad8", quadrilateral, n.quad8, 16, 23, "bar3", on(quadrilateral_edges)},
      {"quad9", quadrilateral, n.quad9, 10, 28, "bar3", quad9},
      {"tri3", triangle, n.tri3, 2, 5, "bar2"},
      {"tri6", triangle, n.tri6, 9, 22, "bar3", on(triangle_edges)},
      {"hex8", hexahedron, n.hex8, 5, 12, "quad4"},
      {.name = "hex20",
       .shape = hexahedron,
       .evaluate = n.hex20,
       .gmsh = 17,
       .vtk = 25,
       .facet_name = "quad8",
       .between = on(hexahedron_edges),
       .vtk_nodes = {0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15},
       .exodus_nodes = {0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 12, 9, 13, 10, 14, 15, 16, 19, 17, 18}},
      {"tet4", tetrahedron, n.tet4, 4, 10, "tri3"},
      {"tet10", tetrahedron, n.tet10, 11, 24, "tri6", on(tetrahedron_edges), tet10, tet10},
  };
}

/// Nodes of a facet with such corners: those that lie between the corners of the cell between
/// which those of the facet's own element lie.
std::vector<int> facet_nodes(const Element& cell, const std::vector<int>& corners,
                             const Element& facet) {
  std::vector<int> nodes = corners;
  for (const std::vector<int>& own : facet.between) {
    std::vector<int> of_cell;
    for (const int corner : own) of_cell.push_back(corners[corner]);
    const auto found = std::ranges::find_if(cell.between, [&of_cell](const std::vector<int>& all) {
      return std::ranges::is_permutation(all, of_cell);
    });
    ABUT_ASSERT(found != cell.between.end());
    nodes.push_back(cell.corner_count() + static_cast<int>(found - cell.between.begin()));
  }
  return nodes;
}

Element made_element(const Entry& entry, std::span<const Element> above) {
  const Corners corners = corners_of(entry.shape);
  Element element;
  element.name = entry.name;
  element.shape = entry.shape;
  element.dim = corners.dim;
  element.nodes = element.corner_count() + static_cast<int>(entry.between.size());
  element.order = entry.between.empty() ? 1 : 2;
  element.facet_name = entry.facet_name;
  element.between = entry.between;
  element.evaluate = entry.evaluate;
  element.gmsh = entry.gmsh;
  element.vtk = entry.vtk;
  element.vtk_nodes = entry.vtk_nodes;
  element.exodus_nodes = entry.exodus_nodes;
  element.corners = corners.places;
  const auto dim = index(corners.dim);
  for (const std::vector<int>& parents : entry.between) {
    for (std::size_t d = 0; d < dim; ++d) {
      double sum = 0.0;
      for (const int corner : parents) sum += corners.places[index(corner) * dim + d];
      element.corners.push_back(sum / static_cast<double>(parents.size()));
    }
  }
  if (corners.facets.empty()) return element;
  const auto facet = std::ranges::find(above, entry.facet_name, &Element::name);
  ABUT_ASSERT(facet != above.end());
  // Surfaces know the functions of facets without nodes inside: contract/whole_facets.cpp has their
  // straight parts and surface/whole_facet.cpp their functions.
  ABUT_ASSERT(std::ranges::all_of(facet->between, [](const auto& of) { return of.size() == 2; }));
  for (const std::vector<int>& own : corners.facets)
    element.facets.push_back(facet_nodes(element, own, *facet));
  return element;
}

std::vector<Element> make_elements() {
  std::vector<Element> all;
  for (const Entry& entry : entries()) all.push_back(made_element(entry, all));
  return all;
}

}  // namespace

std::span<const Element> all_elements() {
  static const std::vector<Element> all = make_elements();
  return all;
}

}  // namespace abut
