#pragma once

#include <cstdint>
#include <vector>

#include "subdomain_solver/fe/element.hpp"

namespace abut {

/// An element as VTK knows it: its number of the cell type, and for every node in VTK's order our
/// local index of it (vtkCellType.h, and the classes of the cells).
struct VtkCell {
  std::int32_t type = 0;
  std::vector<int> nodes;
};

VtkCell vtk_cell(const Element& element);

}  // namespace abut
