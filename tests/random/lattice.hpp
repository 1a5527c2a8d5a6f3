#pragma once

#include <array>
#include <functional>

#include "tests/random/shape.hpp"

namespace abut {

/// Cells of a lattice whose nodes are put where `place` says: of the unit square or cube, as
/// quad4 or tri3, hex8 or tet4. `round`: its first axis closes upon itself.
Shape lattice(Draw& draw, const std::string& element, std::array<int, 3> counts, bool round,
              const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& place);
/// Every triangle of a part as four.
void refine_triangles(Shape& shape);
/// Every tetrahedron as eight.
void refine_tetrahedra(Shape& shape);
/// Triangles in the plane z = 0 as a prism of tetrahedra of this depth.
Shape prism(const Shape& flat, double depth, int layers);
/// Straight cells with nodes on their edges.
void raise_order(Shape& shape);
/// Turns round what is inside out: cells of simplices.
void orient(Shape& shape);
/// Whether all corners of all cells open the right way.
bool sound(const Shape& shape);

}  // namespace abut
