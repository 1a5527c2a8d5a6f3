#include "subdomain_solver/fe/vtk_cells.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <string_view>

#include "base/assert.hpp"
#include "base/index.hpp"

namespace abut {

namespace {

struct Row {
  std::string_view element;
  std::int32_t type;
};
constexpr std::array<Row, 11> types = {{{"point1", 1},
                                        {"bar2", 3},
                                        {"bar3", 21},
                                        {"tri3", 5},
                                        {"tri6", 22},
                                        {"quad4", 9},
                                        {"quad8", 23},
                                        {"tet4", 10},
                                        {"tet10", 24},
                                        {"hex8", 12},
                                        {"hex20", 25}}};

// Both begin with the corners in the same order and differ in the order of edges. VTK goes around
// the base, then up: tet10 01 12 20 03 13 23, hex20 around the lower face, the upper one, and the
// edges between them.
constexpr std::array<int, 10> tet10_nodes = {0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
constexpr std::array<int, 20> hex20_nodes = {0,  1, 2,  3,  4,  5,  6,  7,  8,  11,
                                             13, 9, 16, 18, 19, 17, 10, 12, 14, 15};

}  // namespace

VtkCell vtk_cell(const Element& element) {
  const auto row = std::find_if(types.begin(), types.end(), [&element](const Row& entry) {
    return entry.element == element.name;
  });
  ABUT_ASSERT(row != types.end());
  VtkCell cell{row->type, std::vector<int>(index(element.nodes))};
  std::iota(cell.nodes.begin(), cell.nodes.end(), 0);
  if (element.name == "tet10") cell.nodes.assign(tet10_nodes.begin(), tet10_nodes.end());
  if (element.name == "hex20") cell.nodes.assign(hex20_nodes.begin(), hex20_nodes.end());
  return cell;
}

}  // namespace abut
