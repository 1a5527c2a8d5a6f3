// Goal: prisms and pyramids become tetrahedra that fill them and meet in whole faces, beside
// hexahedra too, in first and second order. Oracles: volumes and surfaces of the whole; every facet
// inside belongs to two cells.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/index.hpp"
#include "subdomain_solver/fe/gmsh_file.hpp"
#include "tests/support/mesh_measures.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::fe_divide_cells_tests {
namespace {

struct Cell {
  int type;                // Gmsh's number
  std::vector<int> nodes;  // counted from 0
};

/// A hexahedron, a prism beside it and a pyramid on top of the hexahedron:
/// 4 + 2 + 4/3.
const std::vector<std::array<double, 3>> points = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0},
                                                   {0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1},
                                                   {4, 0, 0}, {4, 0, 1}, {1, 1, 2}};
const std::vector<Cell> cells = {
    {5, {0, 1, 2, 3, 4, 5, 6, 7}}, {6, {1, 8, 2, 5, 9, 6}}, {7, {4, 5, 6, 7, 10}}};
constexpr double volume = 4.0 + 2.0 + 4.0 / 3.0;

/// Gmsh's nodes on edges of its types, by pairs of corners (its manual, "Node ordering").
const std::vector<std::vector<std::array<int, 2>>> edges = {
    {{0, 1},
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
     {6, 7}},
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}},
    {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 4}, {2, 3}, {2, 4}, {3, 4}}};
constexpr int quadratic_types[] = {17, 18, 19};

/// `order`: of the nodes in the file. The bottom of the hexahedron is a group.
std::string text_of(const std::vector<int>& order, bool quadratic) {
  std::vector<std::array<double, 3>> all = points;
  std::vector<Cell> own = cells;
  std::vector<Cell> bottom = {{quadratic ? 16 : 3, {0, 3, 2, 1}}};
  std::map<std::array<int, 2>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [entry, fresh] =
        middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<int>(all.size()));
    if (fresh) {
      std::array<double, 3> at{};
      for (std::size_t d = 0; d < 3; ++d) at[d] = 0.5 * (points[index(a)][d] + points[index(b)][d]);
      all.push_back(at);
    }
    return entry->second;
  };
  for (std::size_t c = 0; c < own.size() && quadratic; ++c) {
    for (const std::array<int, 2>& edge : edges[c])
      own[c].nodes.push_back(
          middle(cells[c].nodes[index(edge[0])], cells[c].nodes[index(edge[1])]));
    own[c].type = quadratic_types[c];
  }
  for (std::size_t k = 0; k < 4 && quadratic; ++k)
    bottom[0].nodes.push_back(middle(bottom[0].nodes[k], bottom[0].nodes[(k + 1) % 4]));
  std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"bottom\"\n"
      "3 2 \"part\"\n$EndPhysicalNames\n$Nodes\n";
  text += fmt::format("{}\n", all.size());
  for (const int n : order)
    text +=
        fmt::format("{} {} {} {}\n", n + 1, all[index(n)][0], all[index(n)][1], all[index(n)][2]);
  for (std::size_t n = points.size(); n < all.size(); ++n)
    text += fmt::format("{} {} {} {}\n", n + 1, all[n][0], all[n][1], all[n][2]);
  text += fmt::format("$EndNodes\n$Elements\n{}\n", own.size() + 1);
  int tag = 0;
  for (const auto& [group, list] : {std::pair(1, bottom), std::pair(2, own)})
    for (const Cell& cell : list) {
      text += fmt::format("{} {} 2 {} 1", ++tag, cell.type, group);
      for (int n : cell.nodes) text += fmt::format(" {}", n + 1);
      text += "\n";
    }
  return text + "$EndElements\n";
}

TEST(DividedCells, FillTheirPlaceAndMeetInWholeFacesWhateverTheirNumbers) {
  std::mt19937 random(7);
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  for (int k = 0; k < 60; ++k) {
    const bool quadratic = k % 2 == 1;
    SCOPED_TRACE(fmt::format("numbering {}", k));
    std::vector<std::string> notes;
    const Mesh mesh = gmsh_mesh(text_of(order, quadratic), "part.msh", 1.0, 0, &notes);
    check_mesh(mesh, "part.msh");
    ASSERT_EQ(mesh.cell_count(), 6 + 3 + 2);
    for (const CellBlock& block : mesh.blocks) EXPECT_EQ(block.element->nodes, quadratic ? 10 : 4);
    const MeshMeasures measures(mesh);
    // sums over some hundred points of cells and facets
    EXPECT_NEAR(measures.volume(), volume, roundoff(4000, volume));
    const MeshMeasures::Surface all = measures.surface("boundary");
    // sides of the block but those of its neighbours, of the prism, and of the pyramid
    const double surface = (4 + 2 + 2 + 2) + (2 + 2 + 2 + 2 * std::sqrt(2.0)) + 4 * std::sqrt(2.0);
    EXPECT_NEAR(all.area, surface, roundoff(4000, surface));
    for (double part : all.vector) EXPECT_NEAR(part, 0.0, roundoff(4000, surface));
    EXPECT_NEAR(measures.surface("bottom").vector[2], -4.0, roundoff(500, 4.0));
    EXPECT_EQ(mesh.side("bottom").size(), 2u);
    EXPECT_EQ(
        notes.at(0).rfind("1 hexahedron and 1 prism and 1 pyramid divided into 11 tetrahedra", 0),
        0u);
    EXPECT_EQ(notes.at(0).find("stiff") == std::string::npos, quadratic);
    std::shuffle(order.begin(), order.end(), random);
  }
}

TEST(DividedCells, OfSecondOrderHaveTheirNewNodesOnTheCellsOwnFaces) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  const Mesh mesh = gmsh_mesh(text_of(order, true), "part.msh");
  for (const CellBlock& block : mesh.blocks) {
    for (int c = 0; c < block.count(); ++c) {
      const std::span<const std::int32_t> nodes = nodes_of(block, c);
      for (std::size_t m = 0; m < 6; ++m)
        for (std::size_t d = 0; d < 3; ++d) {
          const std::vector<int>& ends = block.element->between[m];
          const double middle = 0.5 * (mesh.points[3 * index(nodes[index(ends[0])]) + d] +
                                       mesh.points[3 * index(nodes[index(ends[1])]) + d]);
          // the part is straight: weights of up to 20 nodes with coordinates up to 4
          EXPECT_NEAR(mesh.points[3 * index(nodes[4 + m]) + d], middle, roundoff(40, 4.0));
        }
    }
  }
}

TEST(DividedCells, WithNodesInsideOfFacesAreRefused) {
  std::string text = text_of({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, false);
  text.replace(text.find("3 6 2 2"), 7, "3 13 2 2");
  expect_words(refusal([&text] { gmsh_mesh(text, "part.msh"); }),
               {"type 13", "Mesh.SecondOrderIncomplete = 1"});
}

}  // namespace
}  // namespace abut::fe_divide_cells_tests
