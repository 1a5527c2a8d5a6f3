#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "tests/random/draw.hpp"

namespace abut {

/// A random part: its mesh, as points and cells of one element.
struct Shape {
  int dim = 2;
  std::string kind;  // rectangle, triangle, spike, arch, ring, brick, wedge, pyramid, tetrahedron
  std::string element;                  // tri3, quad4, tri6, tet4, hex8, tet10
  std::vector<Eigen::Vector3d> points;  // [m]
  std::vector<std::vector<int>> cells;  // in the order of Gmsh
  std::string generator;  // the same mesh as a scene's generator makes it; may be empty
  /// Of a part that is cut out of another one: facets by the name of the cut.
  std::map<std::string, std::vector<std::vector<int>>> cuts;
  bool closed = false;  // its skin is all of its outside, cuts too

  /// Facets by their corners that belong to one cell alone.
  std::vector<std::vector<int>> outside() const;
  double shortest_edge() const;  // [m] of straight cells
  double size() const;           // [m] largest extent
  /// Text of an MSH 4.1 file with a physical group of all facets, "skin" (but those of cuts where
  /// it is not closed), of
  /// those among them at the lower end of the second axis, "bottom", where there are any, and of
  /// each cut.
  std::string gmsh() const;
  bool has_bottom() const { return !bottom().empty(); }
  bool is_cut(const std::vector<int>& facet) const;

  std::vector<std::vector<int>> bottom() const;  // facets, as outside() has them, not of cuts
};

/// Places of a cell's edges in it, in the order of Gmsh's nodes on edges.
std::vector<std::array<int, 2>> edges_of(const std::string& element);

/// A part of about this size, whose centre of points is at the origin.
Shape random_shape(Draw& draw, int dim, double size);
/// A rectangle or a box that is broad along all axes but the second one.
Shape random_floor(Draw& draw, int dim, double width);

}  // namespace abut
