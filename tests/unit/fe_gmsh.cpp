// Goal: Gmsh files give the mesh that Gmsh made, and anything else is refused with its place.
// Oracles: files made by Gmsh of parts with known measures (tests/data/gmsh); one written by hand.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <initializer_list>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/gmsh_file.hpp"
#include "subdomain_solver/fe/gmsh_text.hpp"
#include "subdomain_solver/fe/shape_functions.hpp"
#include "tests/support/mesh_measures.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/solids.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::fe_gmsh_tests {
namespace {

std::string path_of(const std::string& file) {
  return std::string(ABUT_SOURCE_DIR) + "/tests/data/gmsh/" + file;
}

std::string bytes_of(const std::string& file) {
  std::ifstream stream(path_of(file), std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return bytes.str();
}

std::string refusal_of(const std::string& bytes) {
  return refusal([&bytes]() { gmsh_mesh(bytes, "part.msh"); });
}

class GmshBlocks : public testing::TestWithParam<const char*> {};

TEST_P(GmshBlocks, HaveTheirVolumesSidesAndSets) {
  const Mesh mesh = read_gmsh(path_of(GetParam()));
  check_mesh(mesh, GetParam());
  const MeshMeasures measures(mesh);
  EXPECT_EQ(mesh.dim, 3);
  // printed with 16 digits, each within an ulp; a few hundred points of sums up to 6
  EXPECT_NEAR(measures.volume(), 6.0, roundoff(2000, 6.0));
  ASSERT_EQ(mesh.blocks.size(), 2u);
  EXPECT_EQ(mesh.blocks[0].name, "steel");
  EXPECT_EQ(mesh.blocks[1].name, "lead");
  EXPECT_NEAR(measures.surface("bottom").vector[2], -2.0, roundoff(500, 2.0));
  EXPECT_NEAR(measures.surface("top of it").vector[2], 2.0, roundoff(500, 2.0));
  EXPECT_EQ(mesh.sides.size(), 4u);  // and all of the boundary, and the one without a name:
  EXPECT_NEAR(measures.surface("surface_77").vector[1], -6.0, roundoff(500, 6.0));
  EXPECT_NEAR(measures.surface("boundary").area, 22.0, roundoff(2000, 22.0));
  for (std::int32_t n : mesh.nodes_of("between"))
    EXPECT_NEAR(mesh.points[3 * n + 2], 1.0, roundoff(4, 1.0));
  EXPECT_GE(mesh.nodes_of("between").size(), 4u);
  EXPECT_EQ(mesh.nodes_of("edge").size(), mesh.blocks[0].element->order == 2 ? 3u : 2u);
  ASSERT_EQ(mesh.nodes_of("origin").size(), 1u);
  const auto origin = index(mesh.nodes_of("origin")[0]);
  for (std::size_t d = 0; d < 3; ++d) EXPECT_EQ(mesh.points[3 * origin + d], 0.0);
}

TEST_P(GmshBlocks, HaveTheNodesBetweenCornersWhereOurOrderPutsThem) {
  const Mesh mesh = read_gmsh(path_of(GetParam()));
  for (const CellBlock& block : mesh.blocks) {
    const Element& element = *block.element;
    const auto nodes = index(element.nodes);
    const Element& linear = element_named(element.shape == Shape::hexahedron ? "hex8" : "tet4");
    for (std::size_t first = 0; first < block.nodes.size(); first += nodes) {
      for (std::size_t a = 0; a < nodes; ++a) {
        // the parts' cells are straight: the corners' map gives the other nodes
        std::vector<double> n(index(linear.nodes)), dn(3 * n.size());
        linear.evaluate(std::span(element.corners).subspan(3 * a, 3), n, dn);
        for (std::size_t d = 0; d < 3; ++d) {
          double x = 0.0;
          for (std::size_t c = 0; c < n.size(); ++c)
            x += n[c] * mesh.points[3 * index(block.nodes[first + c]) + d];
          const double own = mesh.points[3 * index(block.nodes[first + a]) + d];
          EXPECT_NEAR(own, x, 1e-10) << a;  // Gmsh finds places on curves to about 1e-11
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Files, GmshBlocks,
                         testing::Values("block_tet4.msh", "block_tet10.msh",
                                         "block_tet10_binary.msh", "block_hex8_binary.msh",
                                         "block_hex20.msh", "block_2.2.msh"),
                         [](const testing::TestParamInfo<const char*>& item) {
                           std::string name = item.param;
                           name = name.substr(0, name.find(".msh"));
                           std::ranges::replace(name, '.', '_');
                           return name;
                         });

TEST(GmshFile, TextAndBinaryAreTheSameMesh) {
  const Mesh text = read_gmsh(path_of("block_tet10.msh"));
  const Mesh binary = read_gmsh(path_of("block_tet10_binary.msh"));
  ASSERT_EQ(text.points.size(), binary.points.size());
  // 16 digits are printed
  EXPECT_LE(largest_difference(text.points, binary.points), roundoff(2, 3.0));
  for (std::size_t b : {0u, 1u}) EXPECT_EQ(text.blocks[b].nodes, binary.blocks[b].nodes);
  EXPECT_EQ(text.sides, binary.sides);
  EXPECT_EQ(text.node_sets, binary.node_sets);
}

TEST(GmshFile, PlanePartsKeepTheirCurvedSides) {
  for (const char* file : {"plate_tri6.msh", "plate_quad8.msh"}) {
    const Mesh mesh = read_gmsh(path_of(file));
    check_mesh(mesh, file);
    EXPECT_EQ(mesh.dim, 2);
    const MeshMeasures measures(mesh);
    const double hole = -0.5 * measures.surface("hole").flux;
    EXPECT_NEAR(measures.volume() + hole, 6.0, roundoff(5000, 6.0));
    // chords of equal arcs with parabolas above them
    const auto arcs = static_cast<double>(mesh.side("hole").size());
    const double half = std::numbers::pi / arcs;
    const double arc =
        0.5 * std::sin(2.0 * half) + 4.0 / 3.0 * std::sin(half) * (1.0 - std::cos(half));
    EXPECT_NEAR(hole, 0.25 * arcs * arc, 1e-10) << file;  // Gmsh's own precision, as below
    for (std::int32_t n : mesh.nodes_of("hole")) {
      const double* x = &mesh.points[2 * n];
      EXPECT_NEAR(std::hypot(x[0] - 1.0, x[1] - 1.0), 0.5, 1e-10);  // Gmsh's own precision
    }
    EXPECT_NEAR(measures.surface("right").vector[0], 2.0, roundoff(100, 2.0));
    EXPECT_EQ(mesh.nodes_of("corner").size(), 1u);
    EXPECT_TRUE(mesh.node_sets.contains("plate"));
  }
}

TEST(GmshFile, ScalesTheFilesUnit) {
  const Mesh mesh = read_gmsh(path_of("block_tet4.msh"), 1e-3);
  EXPECT_NEAR(MeshMeasures(mesh).volume(), 6e-9, roundoff(2000, 6e-9));
}

/// Two triangles in the plane, with the side `below`, the point `here` and a loose node 9.
const std::string by_hand = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
3
0 5 "here"
1 6 "below"
2 7 "inside"
$EndPhysicalNames
$Entities
1 2 1 0
1 0 0 0 1 5
1 0 0 0 1 0 0 1 6 2 1 2
2 0 0 0 1 1 0 0 2 1 3
1 0 0 0 1 1 0 1 7 0
$EndEntities
$Nodes
1 5 1 9
2 1 0 5
1
2
3
4
9
0 0 0
1 0 0
1 1 0
0 1 0
7 7 0
$EndNodes
$Elements
4 5 1 5
0 1 15 1
1 1
1 1 1 1
2 1 2
1 2 1 1
3 1 3
2 1 2 2
4 1 2 3
5 1 3 4
$EndElements
)";

std::string with(const std::string& old, const std::string& other) {
  std::string text = by_hand;
  const std::size_t at = text.find(old);
  if (at == std::string::npos) ADD_FAILURE() << old;
  return text.replace(at, old.size(), other);
}

TEST(GmshFile, ByHandIsRead) {
  std::string dos = by_hand;  // line ends of another system
  for (std::size_t at = 0; (at = dos.find('\n', at)) != std::string::npos; at += 2)
    dos.replace(at, 1, "\r\n");
  const std::string more = by_hand + "$Comments\n$Nodes is a word here\n$EndComments\n";
  for (const std::string& text : {by_hand, dos, more}) {
    const Mesh mesh = gmsh_mesh(text, "part.msh");
    check_mesh(mesh, "part.msh");
    EXPECT_EQ(mesh.node_count(), 4);
    EXPECT_EQ(mesh.side("below"), (std::vector<Facet>{{0, 0, 0}}));
    EXPECT_EQ(mesh.nodes_of("here"), (std::vector<std::int32_t>{0}));
    EXPECT_EQ(mesh.nodes_of("inside").size(), 4u);
    EXPECT_EQ(mesh.blocks[0].name, "inside");
  }
}

TEST(GmshFile, AGroupOfFacetsBetweenCellsIsANodeSet) {
  // the diagonal, on a curve in the group `below` of its own; the curve has no other element
  const Mesh mesh = gmsh_mesh(with("2 1 2\n1 2 1 1", "2 1 3\n1 2 1 1"), "part.msh");
  EXPECT_FALSE(mesh.sides.contains("below"));
  EXPECT_EQ(mesh.nodes_of("below"), (std::vector<std::int32_t>{0, 2}));
}

TEST(GmshFile, AGroupInsideTheBodyTakesNoLoadAndSaysWhy) {
  const Mesh mesh = gmsh_mesh(with("2 1 2\n1 2 1 1", "2 1 3\n1 2 1 1"), "part.msh");
  expect_words(refusal([&mesh]() { std::ignore = mesh.side("below"); }),
               {"'below'", "lies inside the body", "Constraints, ports and points"});
}

TEST(GmshFile, ASidePartlyInsideTheBodyIsRefused) {
  // the diagonal in the group of the lower side too
  std::string text = with("1 1 1 1\n2 1 2\n", "1 1 1 2\n2 1 2\n6 1 3\n");
  text.replace(text.find("4 5 1 5"), 7, "4 6 1 6");
  expect_words(refusal_of(text), {"'below'", "partly on the boundary", "lies inside"});
}

TEST(GmshFile, ACellListedTwiceIsRefusedWithBothNumbers) {
  // the second triangle again, from another corner on
  std::string text = with("2 1 2 2\n4 1 2 3\n5 1 3 4\n", "2 1 2 3\n4 1 2 3\n5 1 3 4\n6 3 4 1\n");
  text.replace(text.find("4 5 1 5"), 7, "4 6 1 6");
  expect_words(refusal_of(text),
               {"part.msh", "a cell twice", "cell 2 (tri3", "cell 3 (tri3", "Remove one"});
}

TEST(GmshFile, OfEveryElementIsReadAsTheMeshThatWasWritten) {
  for (const std::string& element : fe_elements()) {
    SCOPED_TRACE(element);
    const Mesh mesh = unit_mesh(element, 2);
    const Mesh read = gmsh_mesh(gmsh_text(mesh), "part.msh");
    ASSERT_EQ(read.blocks.size(), 1u);
    EXPECT_EQ(read.blocks[0].element, mesh.blocks[0].element);
    EXPECT_EQ(read.blocks[0].nodes, mesh.blocks[0].nodes);
    EXPECT_EQ(read.points, mesh.points);  // the shortest digits that give the number back
    EXPECT_EQ(read.side("right").size(), mesh.side("right").size());
  }
}

TEST(GmshFile, HasQuad9AsGmshNumbersIt) {
  // type 10: corners, edges from the first corner on, the middle (Gmsh's manual, node ordering)
  const Mesh mesh = gmsh_mesh(
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 1 0\n1 0 0 0 1 1 0 0 0\n"
      "$EndEntities\n$Nodes\n1 9 1 9\n2 1 0 9\n1\n2\n3\n4\n5\n6\n7\n8\n9\n"
      "0 0 0\n2 0 0\n2 2 0\n0 2 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n1 1 0\n$EndNodes\n"
      "$Elements\n1 1 1 1\n2 1 10 1\n1 1 2 3 4 5 6 7 8 9\n$EndElements\n",
      "square.msh");
  check_mesh(mesh, "square.msh");
  ASSERT_EQ(mesh.blocks[0].element->name, "quad9");
  const Element& element = *mesh.blocks[0].element;
  for (std::size_t k = 0; k < element.corners.size(); ++k)
    EXPECT_EQ(mesh.points[k], element.corners[k] + 1.0);
}

TEST(GmshFile, OtherVersionsPartitionsAndElementsAreRefusedWithARemedy) {
  const auto of_file = [](const char* file) {
    return refusal([file]() { read_gmsh(path_of(file)); });
  };
  expect_words(of_file("block_4.0.msh"), {"block_4.0.msh:2", "version 4", "msh41"});
  expect_words(of_file("block_partitioned.msh"), {"partition"});
  expect_words(of_file("block_hex27.msh"), {"type 1", "SecondOrderIncomplete"});
  expect_words(of_file("missing.msh"), {"missing.msh", "cannot be opened"});
  expect_words(of_file("block.geo"), {"block.geo:1", "not a Gmsh mesh"});
  expect_words(refusal_of(""), {"part.msh:1", "not a Gmsh mesh"});
  expect_words(refusal_of(with("2 1 2 2\n", "2 1 13 2\n")),
               {"part.msh:39", "type 13", "SecondOrder"});
  expect_words(refusal_of(with("4.1 0 8", "4.1 0 4")), {"part.msh:2", "4.1 0 4"});
}

/// The same part in version 2.2: a line per element with physical group and entity.
const std::string listed = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
0 5 "here"
1 6 "below"
2 7 "inside"
$EndPhysicalNames
$Nodes
5
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
9 7 7 0
$EndNodes
$Elements
5
1 15 2 5 1 1
2 1 2 6 1 1 2
3 1 2 0 2 1 3
4 2 2 7 1 1 2 3
5 2 2 7 1 1 3 4
$EndElements
)";

std::string listed_with(const std::string& old, const std::string& other) {
  std::string text = listed;
  const std::size_t at = text.find(old);
  if (at == std::string::npos) ADD_FAILURE() << old;
  return text.replace(at, old.size(), other);
}

TEST(GmshFile, OfVersion22IsTheMeshOfVersion41) {
  const Mesh mesh = gmsh_mesh(listed, "part.msh"), same = gmsh_mesh(by_hand, "part.msh");
  check_mesh(mesh, "part.msh");
  EXPECT_EQ(mesh.points, same.points);
  ASSERT_EQ(mesh.blocks.size(), 1u);
  EXPECT_EQ(mesh.blocks[0].nodes, same.blocks[0].nodes);
  EXPECT_EQ(mesh.blocks[0].name, "inside");
  EXPECT_EQ(mesh.sides, same.sides);
  EXPECT_EQ(mesh.node_sets, same.node_sets);
}

TEST(GmshFile, OfVersion22HasGroupsWhateverItsEntitiesAre) {
  // other programs write one entity for all groups, no tags, the number of partitions, a sign
  const Mesh one = gmsh_mesh(listed_with("5 2 2 7 1 1 3 4", "5 2 2 8 1 1 3 4"), "part.msh");
  ASSERT_EQ(one.blocks.size(), 2u);
  EXPECT_EQ(one.blocks[1].name, "surface_8");
  EXPECT_EQ(one.nodes_of("inside").size(), 3u);
  const Mesh none = gmsh_mesh(listed_with("5 2 2 7 1 1 3 4", "5 2 0 1 3 4"), "part.msh");
  ASSERT_EQ(none.blocks.size(), 2u);
  EXPECT_EQ(none.blocks[1].name, "");
  const Mesh parts = gmsh_mesh(listed_with("2 1 2 6 1 1 2", "2 1 4 -6 1 1 3 1 2"), "part.msh");
  EXPECT_EQ(parts.side("below"), (std::vector<Facet>{{0, 0, 0}}));
}

TEST(GmshFile, OfVersion22ListsAnElementOnceForEachOfItsGroups) {
  std::string text = listed_with("5 2 2 7 1 1 3 4", "5 2 2 7 1 1 3 4\n6 2 2 8 1 1 3 4");
  text.replace(text.find("$Elements\n5"), 11, "$Elements\n6");
  const Mesh mesh = gmsh_mesh(text, "part.msh");
  check_mesh(mesh, "part.msh");
  std::size_t cells = 0;
  for (const CellBlock& block : mesh.blocks) cells += block.nodes.size() / 3;
  EXPECT_EQ(cells, 2u);
  EXPECT_EQ(mesh.nodes_of("inside").size(), 4u);
  EXPECT_EQ(mesh.nodes_of("surface_8").size(), 3u);
  // in the same group again it is another cell in the same place
  text.replace(text.find("6 2 2 8"), 7, "6 2 2 7");
  expect_words(refusal_of(text), {"a cell twice"});
}

TEST(GmshFile, WhatIsWrongInVersion22IsRefusedWithItsPlace) {
  expect_words(refusal_of(listed_with("2.2 0 8", "2.2 1 8")), {"part.msh:2", "binary", "text"});
  expect_words(refusal_of(listed_with("2.2 0 8", "2.2 0 4")), {"part.msh:2", "2.2 0 4"});
  expect_words(refusal_of(listed_with("4 2 2 7", "4 13 2 7")), {"part.msh:23", "type 13", "Order"});
  expect_words(refusal_of(listed_with("1 1 2 3", "1 1 2 8")), {"part.msh:23", "node 8", "$Nodes"});
  expect_words(refusal_of(listed_with("9 7 7 0", "4 7 7 0")), {"part.msh:16", "node 4 twice"});
  expect_words(refusal_of(listed_with("1 1 2\n", "1 2 4\n")),
               {"element 2 (bar2) of group 'below'", "facet of no cell"});
  expect_words(refusal_of(listed_with("5\n1 0 0 0", "6\n1 0 0 0")), {"part.msh:17", "$EndNodes"});
  expect_words(refusal_of(listed_with("5\n1 15", "4\n1 15")), {"part.msh:24", "$EndElements"});
  expect_words(refusal_of(listed_with("5\n1 15", "99999\n1 15")), {"part.msh:19", "99999"});
  expect_words(refusal_of(listed_with("4 0 1 0", "4 0 one 0")), {"part.msh:15", "'one'"});
}

TEST(GmshFile, AnotherByteOrderIsRefused) {
  std::string bytes = bytes_of("block_hex8_binary.msh");
  const std::size_t at = bytes.find('\n', bytes.find("4.1 1 8")) + 1;
  std::swap(bytes[at], bytes[at + 3]);
  expect_words(refusal_of(bytes), {"part.msh: byte", "byte order", "text"});
}

TEST(GmshFile, WhatIsNoPartIsRefusedWithItsPlace) {
  expect_words(
      refusal_of(with("1 1 1 1\n2 1 2\n1 2 1 1\n3 1 3\n", "1 1 1 1\n2 1 2\n1 2 1 1\n3 2 4\n")),
      {"not refused"});  // of an entity without a group
  expect_words(refusal_of(with("2 1 2\n1 2 1 1", "2 2 4\n1 2 1 1")),
               {"part.msh:35", "element 2 (bar2) of group 'below'", "facet of no cell"});
  expect_words(refusal_of(with("2 1 2\n1 2 1 1", "2 1 9\n1 2 1 1")),
               {"part.msh:35", "node 9", "in no cell"});
  expect_words(refusal_of(with("1 1\n1 1 1 1", "1 9\n1 1 1 1")), {"group 'here'", "node 9"});
  expect_words(refusal_of(with("4 1 2 3", "4 1 2 8")), {"part.msh:40", "node 8", "$Nodes"});
  expect_words(refusal_of(with("1 6 \"below\"", "1 6 \"inside\"")),
               {"two groups", "inside"});
  expect_words(refusal_of(with("1 1 0\n0 1 0", "1 1 0.5\n0 1 0")), {"plane z", "volume"});
  expect_words(refusal_of(with("3\n4\n9", "3\n3\n9")), {"node 3 twice"});
  expect_words(refusal_of(with("1 5 1 9", "1 6 1 9")), {"announces 6 nodes and has 5"});
  expect_words(refusal_of(with("4 5 1 5", "4 6 1 5")), {"announces 6 elements and has 5"});
  expect_words(refusal_of(with("1 5 1 9", "1 99999999999 1 9")), {"part.msh:18", "99999999999"});
  expect_words(refusal_of(with("0 1 0\n7", "0 one 0\n7")), {"part.msh:28", "'one'", "a number"});
  expect_words(refusal_of(with("0 1 0\n7", "0 1e999 0\n7")), {"part.msh:28", "'1e999'"});
  expect_words(refusal_of(with("1 6 \"below\"", "1 6")), {"without a name"});
}

TEST(GmshFile, EveryTruncationIsRefused) {
  for (const char* file :
       {"block_tet10.msh", "block_tet10_binary.msh", "block_hex8_binary.msh", "block_2.2.msh"}) {
    const std::string bytes = bytes_of(file);
    const std::size_t whole = bytes.find("$EndElements") + std::string("$EndElements").size();
    ASSERT_LT(whole, bytes.size() + 1);
    for (std::size_t size = 0; size < whole; size += size < 200 ? 1 : 50) {
      const std::string text = refusal_of(bytes.substr(0, size));
      EXPECT_EQ(text.rfind("part.msh", 0), 0u) << file << " cut to " << size << ": " << text;
    }
  }
}

TEST(GmshFile, DamagedBytesGiveAMeshOrARefusalAndNothingElse) {
  std::mt19937 random(3);
  int refused = 0;
  for (const char* file : {"block_tet10.msh", "block_hex8_binary.msh", "block_2.2.msh"}) {
    const std::string bytes = bytes_of(file);
    for (int k = 0; k < 2000; ++k) {
      std::string damaged = bytes;
      for (int change = 0; change < 1 + k % 3; ++change)
        damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
      try {
        check_mesh(gmsh_mesh(damaged, "part.msh"), "part.msh");
      } catch (const InputError&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 1000);  // most bytes matter
}

}  // namespace
}  // namespace abut::fe_gmsh_tests
