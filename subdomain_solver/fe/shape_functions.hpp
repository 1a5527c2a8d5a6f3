#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace abut {

/// Two corners between which a node lies.
using Edge = std::array<int, 2>;

// Edges in the order in which the nodes between corners follow the corners.
inline constexpr std::array<Edge, 1> line_edges = {{{0, 1}}};
inline constexpr std::array<Edge, 3> triangle_edges = {{{0, 1}, {1, 2}, {2, 0}}};
inline constexpr std::array<Edge, 4> quadrilateral_edges = {{{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
inline constexpr std::array<Edge, 6> tetrahedron_edges = {
    {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}}};
inline constexpr std::array<Edge, 12> hexahedron_edges = {{{0, 1},
                                                           {0, 3},
                                                           {0, 4},
                                                           {1, 2},
                                                           {1, 5},
                                                           {2, 3},
                                                           {2, 6},
                                                           {3, 7},
                                                           {4, 5},
                                                           {4, 7},
                                                           {5, 6},
                                                           {6, 7}}};

/// Corners of the cube [-1, 1]^Dim: around the lower face, then the upper one.
template <std::size_t Dim>
constexpr auto cube_corners() {
  constexpr double around[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  std::array<std::array<double, Dim>, (1 << Dim)> corner{};
  for (std::size_t a = 0; a < corner.size(); ++a) {
    for (std::size_t d = 0; d < Dim && d < 2; ++d) corner[a][d] = around[a % 4][d];
    if constexpr (Dim == 3) corner[a][2] = a < 4 ? -1.0 : 1.0;
  }
  return corner;
}

/// Corners of the unit simplex: the origin, then one on each axis.
template <std::size_t Dim>
constexpr auto simplex_corners() {
  std::array<std::array<double, Dim>, Dim + 1> corner{};
  for (std::size_t d = 0; d < Dim; ++d) corner[d + 1][d] = 1.0;
  return corner;
}

/// Shape functions n (nodes) and derivatives dn (nodes, dim) at xi (dim), as Element::evaluate.
using Evaluate = void (*)(std::span<const double> xi, std::span<double> n, std::span<double> dn);

struct ShapeFunctions {
  Evaluate point1, bar2, bar3, tri3, tri6, quad4, quad8, quad9, tet4, tet10, hex8, hex20;
};
/// Those of all elements (textbook forms, e.g. Hughes, The Finite Element Method, chapter 3).
const ShapeFunctions& shape_functions();

}  // namespace abut
