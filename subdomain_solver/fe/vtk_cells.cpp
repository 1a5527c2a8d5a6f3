#include "subdomain_solver/fe/vtk_cells.hpp"

#include <numeric>

#include "base/index.hpp"

namespace abut {

VtkCell vtk_cell(const Element& element) {
  VtkCell cell{element.vtk, element.vtk_nodes};
  if (!cell.nodes.empty()) return cell;
  cell.nodes.resize(index(element.nodes));
  std::iota(cell.nodes.begin(), cell.nodes.end(), 0);
  return cell;
}

}  // namespace abut
