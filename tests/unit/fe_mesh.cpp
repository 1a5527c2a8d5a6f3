// Goal: meshes answer for their names, and bad ones are refused with number and position.
// Oracle: small meshes written by hand.

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "subdomain_solver/fe/facet_index.hpp"
#include "subdomain_solver/fe/mesh.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"
#include "tests/support/refusal.hpp"

namespace abut::fe_mesh_tests {
namespace {

/// Two unit squares beside each other, quad4: nodes 0 1 2 below, 3 4 5 above.
Mesh two_squares() {
  Mesh mesh;
  mesh.dim = 2;
  mesh.points = {0, 0, 1, 0, 2, 0, 0, 1, 1, 1, 2, 1};
  mesh.blocks.push_back({&element_named("quad4"), {0, 1, 4, 3, 1, 2, 5, 4}, "", {}});
  mesh.sides["below"] = {{0, 0, 0}, {0, 1, 0}};
  mesh.node_sets["origin"] = {0};
  return mesh;
}

std::string refusal_of(const Mesh& mesh) {
  return refusal([&mesh]() { check_mesh(mesh, "part.msh"); });
}

TEST(Mesh, AnswersForItsNames) {
  const Mesh mesh = two_squares();
  EXPECT_EQ(mesh.node_count(), 6);
  EXPECT_EQ(mesh.cell_count(), 2);
  EXPECT_EQ(mesh.nodes_of("below"), (std::vector<std::int32_t>{0, 1, 2}));
  EXPECT_EQ(mesh.nodes_of("origin"), (std::vector<std::int32_t>{0}));
  EXPECT_EQ(mesh.nodes_of(Facet{0, 1, 2}), (std::vector<std::int32_t>{5, 4}));
  EXPECT_EQ(mesh.side("below").size(), 2u);
  expect_words(refusal([&mesh]() { mesh.side("origin"); }), {"no side called 'origin'", "below"});
  expect_words(refusal([&mesh]() { mesh.nodes_of("above"); }), {"'above'", "below, origin"});
}

TEST(Mesh, FacetsAreFoundByTheirCornersInAnyOrder) {
  const Mesh mesh = two_squares();
  const FacetIndex index(mesh);
  EXPECT_EQ(index.boundary().size(), 6u);
  EXPECT_EQ(index.find(std::vector<std::int32_t>{4, 1}),
            (std::vector<Facet>{{0, 0, 1}, {0, 1, 3}}));
  EXPECT_EQ(index.find(std::vector<std::int32_t>{2, 1}), (std::vector<Facet>{{0, 1, 0}}));
  EXPECT_TRUE(index.find(std::vector<std::int32_t>{0, 5}).empty());
}

TEST(CheckMesh, LetsGoodMeshesPass) {
  EXPECT_NO_THROW(check_mesh(two_squares(), "part.msh"));
  // aspect ratios of 1000 in two directions are thin, not degenerate
  BoxMesh plate{.lengths = {1.0, 1e-3, 1e-3}, .elements = {1, 1, 1}};
  for (const char* element : {"hex8", "hex20", "tet4", "tet10"}) {
    plate.element = element;
    EXPECT_NO_THROW(check_mesh(generate(plate, "plate"), "plate"));
  }
}

TEST(CheckMesh, RefusesInvertedAndFlatCellsWithNumberAndPosition) {
  Mesh mesh = two_squares();
  mesh.points[2 * 4] = 2.5;  // the upper middle node beyond the right one: cell 2 folds
  expect_words(refusal_of(mesh), {"part.msh", "1 inverted or degenerate cells of 2",
                                  "cell 2 (quad4 around (1.875, 0.5) m)"});
  mesh = two_squares();
  mesh.points = {0, 0, 1, 0, 2, 0, 0, 0, 1, 1, 2, 1};  // cell 1 has a corner of 180 degrees
  expect_words(refusal_of(mesh), {"cell 1"});
  mesh = two_squares();
  mesh.blocks[0].nodes = {0, 3, 4, 1, 1, 4, 5, 2};
  expect_words(refusal_of(mesh), {"2 inverted", "wrong way round"});
  mesh.blocks[0].nodes = {0, 1, 3, 4, 1, 2, 4, 5};  // bow ties
  expect_words(refusal_of(mesh), {"2 inverted", "not in the order", "file's format"});
  mesh = two_squares();
  mesh.points[3] = std::numeric_limits<double>::quiet_NaN();
  expect_words(refusal_of(mesh), {"cell 1", "nan"});
}

TEST(CheckMesh, SeesAFlatCellThroughTheRoundingOfFarCoordinates) {
  // a tetrahedron in a skew plane: its Jacobian is rounding, of either sign
  Mesh mesh;
  mesh.dim = 3;
  mesh.blocks.push_back({&element_named("tet4"), {0, 1, 2, 3}, "", {}});
  for (double size : {1e-3, 1.0, 1e6}) {
    for (int k = 0; k < 20; ++k) {
      mesh.points.clear();
      for (const auto& [s, t] : {std::pair(0.1, 0.2), {1.3, 0.1 * k}, {0.4, 1.1}, {0.7, 0.6}})
        for (double slope : {0.3, 0.7, 1.1}) mesh.points.push_back(size * (s * slope + t / slope));
      expect_words(refusal_of(mesh), {"inverted or degenerate"});
    }
  }
}

TEST(CheckMesh, RefusesAQuadraticCellWhoseMiddleNodeIsPastTheQuarter) {
  Mesh mesh;
  mesh.dim = 2;
  const Element& tri6 = element_named("tri6");
  mesh.points = tri6.corners;
  mesh.blocks.push_back({&tri6, {0, 1, 2, 3, 4, 5}, "", {}});
  EXPECT_NO_THROW(check_mesh(mesh, "m"));
  mesh.points[2 * 3] = 0.26;  // between corners 0 and 1: the map folds below a quarter
  EXPECT_NO_THROW(check_mesh(mesh, "m"));
  mesh.points[2 * 3] = 0.24;
  expect_words(refusal_of(mesh), {"cell 1 (tri6"});
}

TEST(CheckMesh, RefusesLooseAndDuplicateNodes) {
  Mesh mesh = two_squares();
  mesh.points.insert(mesh.points.end(), {3.0, 4.0});
  expect_words(refusal_of(mesh), {"node 7 at (3, 4) m", "no cell"});
  mesh = two_squares();  // the squares torn apart: their common nodes twice
  mesh.points.insert(mesh.points.end(), {1.0, 0.0, 1.0, 1.0 + 1e-9});
  mesh.blocks[0].nodes = {0, 1, 4, 3, 6, 2, 5, 7};
  expect_words(refusal_of(mesh), {"nodes 2 and 7 at (1, 0) m", "Merge"});
  mesh.points[2 * 6 + 1] = -1e-3;  // a crack that is open at both ends
  mesh.points[2 * 7 + 1] = 1.001;
  EXPECT_NO_THROW(check_mesh(mesh, "m"));
}

TEST(CheckMesh, RefusesWrongDimensionsNumbersAndNothing) {
  Mesh mesh = two_squares();
  mesh.blocks[0].nodes[3] = 6;
  expect_words(refusal_of(mesh), {"node 7 of 6"});
  mesh = two_squares();
  mesh.dim = 3;
  expect_words(refusal_of(mesh), {"2 dimensions (quad4)", "space of 3"});
  mesh.dim = 0;
  expect_words(refusal_of(mesh), {"0 dimensions"});
  mesh = two_squares();
  mesh.blocks.clear();
  expect_words(refusal_of(mesh), {"no cells"});
}

}  // namespace
}  // namespace abut::fe_mesh_tests
