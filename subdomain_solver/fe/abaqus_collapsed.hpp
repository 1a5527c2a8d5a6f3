#pragma once

#include <optional>
#include <vector>

#include "subdomain_solver/fe/abaqus_elements.hpp"

namespace abut {

/// What an element is whose nodes repeat, so that edges or faces of it have shrunk to a point: a
/// hexahedron that is a prism, a pyramid or a tetrahedron, a quadrilateral that is a triangle.
struct CollapsedElement {
  /// The shape, with the faces of the element that it came from, S1, S2, ..., by its own nodes;
  /// those that have shrunk to a line or a point are empty.
  AbaqusElement type;
  std::vector<int> nodes;  // (type.nodes) of the element that it came from
};

/// `alike`: (nodes of `whole`) the first of its nodes that each one is. Nothing: it is none of
/// these shapes, or a middle node is kept where an edge has gone.
std::optional<CollapsedElement> collapsed(const AbaqusElement& whole,
                                          const std::vector<int>& alike);

}  // namespace abut
