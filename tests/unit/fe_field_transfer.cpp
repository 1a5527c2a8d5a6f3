// Goal: a field goes from one mesh of a body to another as the nearest one. Oracles: linear fields,
// which every mesh has; a coarse mesh's fields on one that divides its cells; the field itself on
// the same mesh; cells found where their own shape functions say that a place is.
#include "subdomain_solver/fe/field_transfer.hpp"

#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/cell_finder.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"
#include "subdomain_solver/solid_fields.hpp"

namespace abut::fe_field_transfer_tests {
namespace {

constexpr double digits = 1.0e-11;  // of fields of size 1, by a mass matrix of condition 1e3

template <class Data>
Mesh make_mesh(const Data& data) {
  return generate(data, "mesh");
}

Mesh block(const std::string& element, int cells, int dim) {
  if (dim == 1) return make_mesh(BarMesh{.origin = 0.2, .length = 1.0, .elements = cells});
  if (dim == 2)
    return make_mesh(RectangleMesh{.lengths = {1.0, 0.5}, .elements = {cells, cells + 1},
                                   .element = element});
  return make_mesh(BoxMesh{.lengths = {1.0, 0.5, 0.7}, .elements = {cells, cells + 1, cells},
                           .element = element});
}

/// Values (nodes, 3) of a function of the place.
template <class Function>
std::vector<double> field_on(const Mesh& mesh, const Function& function) {
  std::vector<double> out;
  const Grid grid = grid_of(mesh);
  for (std::size_t node = 0; node < grid.nodes(); ++node) {
    const double* x = grid.points.data() + 3 * node;
    for (int i = 0; i < 3; ++i) out.push_back(i < mesh.dim ? function(i, x) : 0.0);
  }
  return out;
}

double linear(int i, const double* x) { return 0.3 + i - 2.0 * x[0] + 1.5 * x[1] + (i - 1) * x[2]; }
double wavy(int i, const double* x) {
  return std::sin(5.0 * x[0] + i) * std::cos(4.0 * x[1]) + x[2];
}

/// Largest difference from a function at the nodes.
template <class Function>
double error(const Mesh& mesh, const std::vector<double>& values, const Function& function) {
  const std::vector<double> exact = field_on(mesh, function);
  const std::size_t dim = index(mesh.dim);
  double most = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k)
    most = std::max(most, std::abs(values[k] - exact[k / dim * 3 + k % dim]));
  return most;
}

std::vector<std::string> elements(int dim) {
  if (dim == 1) return {"bar2"};
  std::vector<std::string> names;
  for (const std::string_view name : generated_elements(dim)) names.emplace_back(name);
  return names;
}

TEST(FieldTransfer, KeepsLinearFieldsBetweenAllElements) {
  for (const int dim : {1, 2, 3})
    for (const std::string& one : elements(dim))
      for (const std::string& other : elements(dim))
        for (const auto [from, to] : {std::pair(2, 3), std::pair(3, 1)}) {
          const Mesh old = block(one, from, dim), now = block(other, to, dim);
          FieldTransfer transfer(grid_of(old), now, false);
          EXPECT_FALSE(transfer.same());
          EXPECT_LT(error(now, transfer.to_nodes(field_on(old, linear)), linear), digits)
              << one << " to " << other << ", " << from << " to " << to;
        }
}

TEST(FieldTransfer, PassesOnTheNumbersOfTheSameMesh) {
  for (const int dim : {1, 2, 3})
    for (const std::string& element : elements(dim)) {
      const Mesh mesh = block(element, 2, dim);
      FieldTransfer transfer(grid_of(mesh), mesh, false);
      EXPECT_TRUE(transfer.same());
      EXPECT_EQ(error(mesh, transfer.to_nodes(field_on(mesh, wavy)), wavy), 0.0) << element;
    }
}

/// There and back: cells that are divided have all fields of the coarse ones.
TEST(FieldTransfer, BringsBackFieldsFromDividedCells) {
  for (const int dim : {2, 3})
    for (const std::string& element : elements(dim)) {
      // Tetrahedra are divided otherwise, and fields of serendipity cells are not those of halves.
      if (element.starts_with("tet") || element == "quad8" || element == "hex20") continue;
      const Mesh coarse = dim == 2 ? make_mesh(RectangleMesh{.lengths = {1.0, 0.5},
                                                             .elements = {2, 3},
                                                             .element = element})
                                   : block(element, 2, 3);
      const Mesh fine =
          dim == 2
              ? make_mesh(RectangleMesh{
                    .lengths = {1.0, 0.5}, .elements = {4, 6}, .element = element})
              : make_mesh(BoxMesh{
                    .lengths = {1.0, 0.5, 0.7}, .elements = {4, 6, 4}, .element = element});
      FieldTransfer there(grid_of(coarse), fine, false), back(grid_of(fine), coarse, false);
      const std::vector<double> on_fine = there.to_nodes(field_on(coarse, wavy));
      const std::vector<double> again = back.to_nodes(in_space(on_fine, dim));
      EXPECT_LT(error(coarse, again, wavy), digits) << element;
    }
}

/// Of first order: the error of the nearest field falls with the square of the cells.
TEST(FieldTransfer, ConvergesWithTheCells) {
  double before = 0.0;
  const Mesh old = block("quad9", 24, 2);
  for (const int cells : {4, 8, 16}) {
    const Mesh now = block("quad4", cells, 2);
    FieldTransfer transfer(grid_of(old), now, false);
    const double now_error = error(now, transfer.to_nodes(field_on(old, wavy)), wavy);
    if (before > 0.0) EXPECT_GT(before / now_error, 3.0);
    before = now_error;
  }
}

/// The chords of a coarse disk leave out places of a finer one.
TEST(FieldTransfer, ReadsPlacesOutsideTheOldMeshByItsNearestCell) {
  const Mesh coarse = make_mesh(DiskMesh{.radius = 1.0, .core = 2, .layers = 1});
  const Mesh fine = make_mesh(DiskMesh{.radius = 1.0, .core = 6, .layers = 4});
  for (const auto& [from, to] : {std::pair(&coarse, &fine), std::pair(&fine, &coarse)}) {
    FieldTransfer transfer(grid_of(*from), *to, false);
    EXPECT_LT(error(*to, transfer.to_nodes(field_on(*from, linear)), linear), digits);
  }
}

TEST(FieldTransfer, RefusesAMeshOfAnotherDimension) {
  const Mesh plane = block("quad4", 2, 2), solid = block("hex8", 1, 3);
  EXPECT_THROW(FieldTransfer(grid_of(plane), solid, false), RunError);
}

TEST(CellFinder, FindsTheCellOfEveryMiddle) {
  for (const int dim : {1, 2, 3})
    for (const std::string& element : elements(dim)) {
      const Mesh mesh = block(element, 3, dim);
      const CellFinder finder(mesh);
      for (int cell = 0; cell < mesh.cell_count(); ++cell) {
        std::vector<double> middle(index(dim), 0.0);
        const std::span<const std::int32_t> nodes = nodes_of(mesh.blocks[0], cell);
        const std::size_t corners = index(mesh.blocks[0].element->corner_count());
        for (std::size_t a = 0; a < corners; ++a)
          for (std::size_t i = 0; i < middle.size(); ++i)
            middle[i] += mesh.points[index(nodes[a]) * middle.size() + i] / corners;
        const CellFinder::Found found = finder.find(middle);
        EXPECT_EQ(found.cell, cell) << element;
        EXPECT_LE(found.outside, 0.0);
      }
    }
}

}  // namespace
}  // namespace abut::fe_field_transfer_tests
