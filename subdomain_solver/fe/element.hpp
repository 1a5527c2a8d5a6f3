#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace abut {

/// Reference shapes on which quadrature rules live. Lines, squares and cubes span [-1, 1] in every
/// direction; triangles and tetrahedra have the unit corner at the origin.
enum class Shape { point, line, triangle, quadrilateral, tetrahedron, hexahedron };

/// A Lagrange or serendipity element as a table, not a class, filled in elements.cpp. Node order
/// is Gmsh's (msh 4.1). Facets are numbered as Exodus numbers sides. The nodes of a facet are in
/// the order of the facet's own element, so that its normal points out of the cell: for faces the
/// right-hand rule, for edges the tangent turned clockwise; ends of a line are its negative and
/// its positive end.
struct Element {
  std::string_view name;  // "hex8"
  Shape shape = Shape::point;
  int dim = 0;  // of the reference shape
  int nodes = 0;
  int order = 1;                         // polynomials of this order are exact on affine cells
  std::string_view facet_name;           // element of the facets: "quad4"; empty for a point
  std::vector<std::vector<int>> facets;  // local nodes of each facet, corners first
  /// Of each node that is no corner: the corners in whose middle it is.
  std::vector<std::vector<int>> between;
  std::vector<double> corners;  // (nodes, dim) reference coordinates of all nodes
  /// Shape functions n (nodes) and their derivatives dn (nodes, dim) at a reference point xi (dim).
  void (*evaluate)(std::span<const double> xi, std::span<double> n, std::span<double> dn) = nullptr;

  int gmsh = 0;          // number of the type in MSH files
  std::int32_t vtk = 0;  // number of the cell type
  /// Our local index of every node in VTK's and in Exodus' order; empty: the order is ours.
  std::vector<int> vtk_nodes, exodus_nodes;

  /// Nodes that are corners of the shape; they come first.
  int corner_count() const;
};

/// The element of a name, e.g. "tet10"; throws InputError that lists the names.
const Element& element_named(std::string_view name);
/// The one of first order.
const Element& linear_element(Shape shape);
/// Names of those of some dimensions that the mesh generators make: all whose nodes have a place in
/// a lattice of half cells, which the middle of a triangle or tetrahedron has not.
std::vector<std::string_view> generated_elements(int dim);
/// All of them, the linear one of a shape before the others.
std::span<const Element> all_elements();

/// Points (count, dim) and weights (count) that integrate polynomials of a degree exactly on the
/// reference shape; the weights are positive and sum to its volume (a point's is 1).
struct Quadrature {
  std::vector<double> points, weights;
  int count() const { return static_cast<int>(weights.size()); }
};
/// The smallest rule that we have of at least this degree: total degree on simplices, degree in
/// each direction on the others. Gauss-Legendre products; on simplices symmetric rules up to degree
/// 6 (sources in quadrature.cpp), above that products on the collapsed square or cube.
Quadrature quadrature(Shape shape, int degree);

/// N (points, nodes), dN (points, nodes, dim) and weights (points) of an element under a rule.
struct Tabulation {
  int points = 0, nodes = 0, dim = 0;
  std::vector<double> weight, n, dn;
};
Tabulation tabulate(const Element& element, const Quadrature& rule);

/// Degree that integrates the element's stiffness (full) on affine cells, and its mass matrix.
int stiffness_degree(const Element& element);
int mass_degree(const Element& element);

}  // namespace abut
