#pragma once

#include <string>
#include <vector>

#include "subdomain_solver/fe/divide_cells.hpp"

namespace abut {

/// An element of Abaqus or CalculiX in terms of ours. Indices of nodes count from 0 in the order of
/// their files.
struct AbaqusElement {
  int dim = 0, nodes = 0;
  bool quadratic = false;
  const Element* type = nullptr;          // null: it is divided
  const DividedShape* divided = nullptr;  // where we have no element of it
  std::vector<int> order;                 // (nodes) its index of each of our nodes
  /// Its nodes of the faces S1, S2, ..., in the order of the face's element; of a line none.
  std::vector<std::vector<int>> faces;
};

/// The element of a name in capitals, with what may stand behind it (R, H, I, M, S and pairs of
/// them: how the element is integrated): C3D4, 6, 8, 10, 15, 20 and the pyramid C3D5; CPS, CPE and
/// CAX 3, 4, 6, 8; and, as names of sides and lines, R3D3, R3D4, T2D2, T3D2, T2D3, T3D3. Null: we
/// do not have it.
const AbaqusElement* abaqus_element(const std::string& name);

/// The element of this shape: triangle, quadrilateral; tetrahedron, pyramid, prism, hexahedron, by
/// their numbers of corners, of first order or with a node on every edge. Null: there is none.
const AbaqusElement* abaqus_shape(int dim, int corners, bool quadratic);

/// Why there is no such element, and what to do.
std::string abaqus_element_remedy(const std::string& name);

}  // namespace abut
