// Goal: input files of Abaqus and CalculiX give the mesh that they say, and anything else is
// refused with its line. Oracles: nodes and faces as the manuals of these programs list them,
// written out by hand on cells of known measures; the same mesh through Gmsh's format.

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/index.hpp"
#include "subdomain_solver/fe/abaqus_file.hpp"
#include "subdomain_solver/fe/gmsh_file.hpp"
#include "tests/support/mesh_measures.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::fe_abaqus_tests {
namespace {

using Point = std::array<double, 3>;

Mesh mesh_of_text(const std::string& text, const std::string& part = "",
                  std::vector<std::string>* notes = nullptr) {
  return abaqus_mesh(text, "part.inp", 1.0, part, 0, notes);
}

std::string refusal_of(const std::string& text, const std::string& part = "") {
  return refusal([&] { mesh_of_text(text, part); });
}

/// One cell: its corners, and the pairs of them between which the manual has nodes, in its order.
struct Cell {
  const char* type;
  double volume;
  std::vector<Point> corners;
  std::vector<std::array<int, 2>> edges;  // counted from 1; none: first order
  /// Of every face S1, S2, ...: the mean of its corners, where it must be.
  std::vector<std::vector<int>> faces;  // counted from 1
};

const std::vector<Point> square = {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}};
const std::vector<Point> corner = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}};
const std::vector<Point> tetrahedron = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 4}};
const std::vector<Point> wedge = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 4}, {2, 0, 4}, {0, 3, 4}};
const std::vector<Point> brick = {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0},
                                  {0, 0, 4}, {2, 0, 4}, {2, 3, 4}, {0, 3, 4}};
const std::vector<Point> pyramid = {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}, {1, 1, 4}};

const std::vector<std::vector<int>> tetrahedron_faces = {
    {1, 2, 3}, {1, 4, 2}, {2, 4, 3}, {3, 4, 1}};
const std::vector<std::vector<int>> wedge_faces = {
    {1, 2, 3}, {4, 6, 5}, {1, 4, 5, 2}, {2, 5, 6, 3}, {3, 6, 4, 1}};
const std::vector<std::vector<int>> brick_faces = {{1, 2, 3, 4}, {5, 8, 7, 6}, {1, 5, 6, 2},
                                                   {2, 6, 7, 3}, {3, 7, 8, 4}, {4, 8, 5, 1}};

std::vector<Cell> cells() {
  return {
      {"C3D4", 4.0, tetrahedron, {}, tetrahedron_faces},
      {"C3D10",
       4.0,
       tetrahedron,
       {{1, 2}, {2, 3}, {3, 1}, {1, 4}, {2, 4}, {3, 4}},
       tetrahedron_faces},
      {"C3D8R", 24.0, brick, {}, brick_faces},
      {"C3D20R",
       24.0,
       brick,
       {{1, 2},
        {2, 3},
        {3, 4},
        {4, 1},
        {5, 6},
        {6, 7},
        {7, 8},
        {8, 5},
        {1, 5},
        {2, 6},
        {3, 7},
        {4, 8}},
       brick_faces},
      {"C3D6", 12.0, wedge, {}, wedge_faces},
      {"C3D15",
       12.0,
       wedge,
       {{1, 2}, {2, 3}, {3, 1}, {4, 5}, {5, 6}, {6, 4}, {1, 4}, {2, 5}, {3, 6}},
       wedge_faces},
      {"C3D5", 8.0, pyramid, {}, {{1, 2, 3, 4}, {1, 5, 2}, {2, 5, 3}, {3, 5, 4}, {4, 5, 1}}},
      {"CPE3", 3.0, corner, {}, {{1, 2}, {2, 3}, {3, 1}}},
      {"CPS6", 3.0, corner, {{1, 2}, {2, 3}, {3, 1}}, {{1, 2}, {2, 3}, {3, 1}}},
      {"CAX4R", 6.0, square, {}, {{1, 2}, {2, 3}, {3, 4}, {4, 1}}},
      {"CPE8H", 6.0, square, {{1, 2}, {2, 3}, {3, 4}, {4, 1}}, {{1, 2}, {2, 3}, {3, 4}, {4, 1}}},
  };
}

/// The cell's file, a node or number a line where the format lets it, each face a surface.
std::string text_of(const Cell& cell) {
  std::string text = "*Heading\n a cell\n*Node\n";
  std::vector<Point> nodes = cell.corners;
  for (const std::array<int, 2>& edge : cell.edges) {
    Point& middle = nodes.emplace_back();
    for (std::size_t d = 0; d < 3; ++d)
      middle[d] = 0.5 * (cell.corners[index(edge[0]) - 1][d] + cell.corners[index(edge[1]) - 1][d]);
  }
  for (std::size_t n = 0; n < nodes.size(); ++n)
    text += fmt::format("{}, {}, {}, {}\n", n + 1, nodes[n][0], nodes[n][1], nodes[n][2]);
  text += fmt::format("*Element, type={}, elset=All\n7", cell.type);
  for (std::size_t n = 0; n < nodes.size(); ++n)
    text += fmt::format(",{}{}", n == 9 ? "\n" : " ", n + 1);
  for (std::size_t f = 0; f < cell.faces.size(); ++f)
    text += fmt::format("\n*Surface, type=ELEMENT, name=face_{}\n All, S{}", f + 1, f + 1);
  return text + "\n";
}

Point centre_of(const Mesh& mesh, const std::string& side) {
  Point low = {1e9, 1e9, 1e9}, high = {-1e9, -1e9, -1e9}, centre{};
  const auto dim = index(mesh.dim);
  for (std::int32_t node : mesh.nodes_of(side))
    for (std::size_t d = 0; d < dim; ++d) {
      low[d] = std::min(low[d], mesh.points[index(node) * dim + d]);
      high[d] = std::max(high[d], mesh.points[index(node) * dim + d]);
    }
  for (std::size_t d = 0; d < dim; ++d) centre[d] = 0.5 * (low[d] + high[d]);
  return centre;
}

TEST(AbaqusFile, OfEveryElementHasItsVolumeItsNodesAndItsFaces) {
  for (const Cell& cell : cells()) {
    SCOPED_TRACE(cell.type);
    const Mesh mesh = mesh_of_text(text_of(cell));
    check_mesh(mesh, cell.type);
    // sums over some points of up to six cells
    EXPECT_NEAR(MeshMeasures(mesh).volume(), cell.volume, roundoff(2000, cell.volume));
    const auto dim = index(mesh.dim);
    for (const CellBlock& block : mesh.blocks) {
      EXPECT_EQ(block.element->order, cell.edges.empty() ? 1 : 2);
      for (int c = 0; c < block.count(); ++c) {
        const std::span<const std::int32_t> nodes = nodes_of(block, c);
        for (std::size_t m = 0; m < block.element->between.size(); ++m) {
          const std::int32_t own = nodes[index(block.element->corner_count()) + m];
          for (std::size_t d = 0; d < dim; ++d) {
            double middle = 0.0;
            for (int end : block.element->between[m])
              middle += 0.5 * mesh.points[index(nodes[index(end)]) * dim + d];
            // of -1/4 and 1/2 of coordinates up to 4, where a diagonal has the node
            EXPECT_NEAR(mesh.points[index(own) * dim + d], middle, roundoff(16, 4.0)) << m;
          }
        }
      }
    }
    for (std::size_t f = 0; f < cell.faces.size(); ++f) {
      Point low = {1e9, 1e9, 1e9}, high = {-1e9, -1e9, -1e9};
      for (int own : cell.faces[f])
        for (std::size_t d = 0; d < 3; ++d) {
          low[d] = std::min(low[d], cell.corners[index(own) - 1][d]);
          high[d] = std::max(high[d], cell.corners[index(own) - 1][d]);
        }
      const Point centre = centre_of(mesh, fmt::format("face_{}", f + 1));
      for (std::size_t d = 0; d < dim; ++d)
        EXPECT_NEAR(centre[d], 0.5 * (low[d] + high[d]), roundoff(16, 4.0)) << "S" << f + 1;
    }
    // together the faces are all of the surface: their area vectors sum to nothing
    double area = 0.0;
    for (std::size_t f = 0; f < cell.faces.size(); ++f)
      area += MeshMeasures(mesh).surface(fmt::format("face_{}", f + 1)).area;
    const double whole = MeshMeasures(mesh).surface("boundary").area;
    EXPECT_NEAR(area, whole, roundoff(2000, whole));
  }
}

/// Two squares in a row.
const std::string plate = R"(** comment
*NODE, NSET=ALL
1, 0., 0.
 2 ,1.0D0,	0
3, 2e0, 0, 0

4, 0., 1
5, +1., 1
6, 2, 1.0d+0
9, 7, 7
*ELEMENT, TYPE=CPS4, ELSET=plate
11, 1,2,5,4
12, 2,3,6,
5
*NSET, NSET=below, GENERATE
1, 3
*NSET, NSET=corners
1, 3
6, 4
*NSET, NSET=most
below, corners
*ELSET, ELSET=right one
12
*SURFACE, NAME=end, TYPE=ELEMENT
Right One, S2
*SURFACE, NAME=tip, TYPE=NODE
3
*SURFACE, NAME=inside
11, S2
*MATERIAL, NAME=STEEL
*ELASTIC
2.1E11, 0.3
*STEP
*STATIC
*END STEP
)";

std::string with(const std::string& old, const std::string& other, std::string text = plate) {
  const std::size_t at = text.find(old);
  if (at == std::string::npos) ADD_FAILURE() << old;
  return text.replace(at, old.size(), other);
}

TEST(AbaqusFile, HasItsSetsAndSurfacesAndTellsWhatItSkips) {
  std::vector<std::string> notes;
  const Mesh mesh = mesh_of_text(plate, "", &notes);
  check_mesh(mesh, "plate");
  EXPECT_EQ(mesh.node_count(), 6);
  EXPECT_NEAR(MeshMeasures(mesh).volume(), 2.0, roundoff(200, 2.0));
  EXPECT_EQ(mesh.nodes_of("below"), (std::vector<std::int32_t>{0, 1, 2}));
  EXPECT_EQ(mesh.nodes_of("corners"), (std::vector<std::int32_t>{0, 2, 3, 5}));
  EXPECT_EQ(mesh.nodes_of("most"), (std::vector<std::int32_t>{0, 1, 2, 3, 5}));
  EXPECT_EQ(mesh.nodes_of("tip"), (std::vector<std::int32_t>{2}));
  EXPECT_EQ(mesh.nodes_of("inside"), (std::vector<std::int32_t>{1, 4}));
  EXPECT_FALSE(mesh.sides.contains("inside"));
  EXPECT_EQ(mesh.side("end").size(), 1u);
  EXPECT_EQ(mesh.nodes_of("end"), (std::vector<std::int32_t>{2, 5}));
  EXPECT_EQ(mesh.nodes_of("plate"), mesh.nodes_of("ALL"));
  EXPECT_EQ(mesh.nodes_of("right one"), (std::vector<std::int32_t>{1, 2, 4, 5}));
  const std::string told = fmt::format("{}", fmt::join(notes, "; "));
  expect_words(told, {"CPS4 as quad4", "skipped, not applied: *MATERIAL, *ELASTIC, *STEP, *STATIC",
                      "1 nodes of no cell left out of sets"});
}

TEST(AbaqusFile, OfASurfaceWithoutFacesHasThoseThatNoOtherCellShares) {
  const Mesh mesh = mesh_of_text(plate + "*SURFACE, NAME=rim\nplate\n*SURFACE, NAME=half\n12\n");
  EXPECT_EQ(mesh.side("rim").size(), 6u);
  EXPECT_EQ(mesh.side("half").size(), 3u);
  EXPECT_EQ(mesh.nodes_of("half"), mesh.nodes_of("right one"));
  for (const Cell& cell : cells()) {
    const Mesh one = mesh_of_text(text_of(cell) + "*Surface, name=skin\nAll\n");
    EXPECT_EQ(one.side("skin").size(), one.side("boundary").size()) << cell.type;
  }
}

TEST(AbaqusFile, IsTheSameWithLinesOfDosAndLongOnes) {
  const Mesh mesh = mesh_of_text(plate);
  std::string dos, wide = plate;
  for (char letter : plate) dos += letter == '\n' ? std::string("\r\n") : std::string(1, letter);
  wide.replace(wide.find("11, 1,2"), 4, "11," + std::string(100000, ' '));
  for (const std::string& text : {dos, wide, plate.substr(0, plate.size() - 1)}) {
    const Mesh same = mesh_of_text(text);
    EXPECT_EQ(same.points, mesh.points);
    EXPECT_EQ(same.blocks.front().nodes, mesh.blocks.front().nodes);
    EXPECT_EQ(same.sides, mesh.sides);
    EXPECT_EQ(same.node_sets, mesh.node_sets);
  }
}

TEST(AbaqusFile, GivesTheMeshThatGmshsFormatGives) {
  const Mesh mesh = mesh_of_text(plate);
  const Mesh gmsh = gmsh_mesh(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 1 \"end\"\n2 2 \"plate\"\n"
      "$EndPhysicalNames\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n"
      "$EndNodes\n$Elements\n3\n1 1 2 1 1 3 6\n11 3 2 2 1 1 2 5 4\n12 3 2 2 1 2 3 6 5\n"
      "$EndElements\n",
      "part.msh");
  EXPECT_EQ(gmsh.points, mesh.points);
  std::vector<std::int32_t> cells;
  for (const CellBlock& block : mesh.blocks)
    cells.insert(cells.end(), block.nodes.begin(), block.nodes.end());
  EXPECT_EQ(gmsh.blocks.front().nodes, cells);
  EXPECT_EQ(gmsh.nodes_of("end"), mesh.nodes_of("end"));
  EXPECT_EQ(gmsh.nodes_of("plate"), mesh.nodes_of("plate"));
}

TEST(AbaqusFile, LinesAndFacetsThatGmshWritesNameSides) {
  const std::string text =
      with("*NSET, NSET=below", "*ELEMENT, TYPE=T3D2, ELSET=left\n1, 4, 1\n*NSET, NSET=below");
  const Mesh mesh = mesh_of_text(text);
  ASSERT_TRUE(mesh.sides.contains("left"));
  EXPECT_EQ(mesh.nodes_of("left"), (std::vector<std::int32_t>{0, 3}));
  expect_words(refusal_of(text + "*SOLID SECTION, ELSET=left, MATERIAL=STEEL\n"),
               {"part.inp:38", "*SOLID SECTION of element 1 (T3D2)", "Trusses"});
}

const std::string assembly = R"(*Heading
*Part, name=square
*Node
1, 0, 0
2, 1, 0
3, 1, 1
4, 0, 1
*Element, type=CPE4
1, 1, 2, 3, 4
*Nset, nset=Set-1
1, 2
*Elset, elset=Set-1
1
*Surface, name=top
1, S3
*End Part
*Assembly, name=Assembly
*Instance, name=lower, part=square
*End Instance
*Instance, name=upper, part=square
3., 0., 0.
3., 0., 0., 3., 0., 1., 90.
*End Instance
*Node
1, 9, 9, 9
*Nset, nset=reference
1
*Nset, nset=held, instance=upper
1, 4
*Nset, nset=both
lower.1, upper.2
*Elset, elset=_up_S1, internal, instance=upper
1
*Surface, name=up
_up_S1, S1
*End Assembly
)";

TEST(AbaqusFile, OfInstancesIsMovedTurnedAndChosen) {
  std::vector<std::string> notes;
  const Mesh both = mesh_of_text(assembly, "", &notes);
  check_mesh(both, "assembly");
  EXPECT_EQ(both.node_count(), 8);
  EXPECT_EQ(both.nodes_of("both"), (std::vector<std::int32_t>{0, 5}));
  EXPECT_EQ(both.nodes_of("upper.top").size(), 2u);
  EXPECT_EQ(notes.at(1), "2 instances are one body: part chooses one");
  const Mesh upper = mesh_of_text(assembly, "Upper");
  check_mesh(upper, "upper");
  // moved by 3 along x, then turned by 90 degrees about (3, 0)
  const std::vector<double> points = {3, 0, 3, 1, 2, 1, 2, 0};
  EXPECT_LE(largest_difference(upper.points, points), roundoff(8, 3.0));
  EXPECT_EQ(upper.nodes_of("held"), (std::vector<std::int32_t>{0, 3}));
  EXPECT_EQ(upper.nodes_of("up"), (std::vector<std::int32_t>{0, 1}));
  EXPECT_EQ(upper.nodes_of("top"), (std::vector<std::int32_t>{2, 3}));
  EXPECT_EQ(upper.nodes_of("Set-1").size(), 4u);
  EXPECT_EQ(upper.nodes_of("Set-1_nodes"), (std::vector<std::int32_t>{0, 1}));
  EXPECT_FALSE(upper.node_sets.contains("reference"));
  expect_words(refusal_of(assembly, "middle"), {"'middle'", "Choose one of lower, upper"});
}

TEST(AbaqusFile, IncludesOthers) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / fmt::format("abaqus_{}", ::getpid());
  std::filesystem::create_directories(folder / "more");
  const auto write = [&folder](const char* name, const std::string& text) {
    std::ofstream(folder / name) << text;
  };
  const std::size_t nodes = plate.find("1, 0."), elements = plate.find("*ELEMENT");
  const std::size_t sets = plate.find("*NSET, NSET=below");
  write("more/nodes.inp", plate.substr(nodes, elements - nodes));
  write("more/rest.txt", plate.substr(sets));
  write("part.inp", "*NODE, NSET=ALL, INPUT=more/nodes.inp\n" +
                        plate.substr(elements, sets - elements) +
                        "*INCLUDE,\n INPUT=more/rest.txt\n");
  const std::string path = (folder / "part.inp").string();
  const Mesh mesh = read_abaqus(path), same = mesh_of_text(plate);
  EXPECT_EQ(mesh.points, same.points);
  EXPECT_EQ(mesh.node_sets, same.node_sets);
  EXPECT_EQ(mesh.sides, same.sides);
  const std::uint64_t digest = digest_of_abaqus(path);
  write("more/rest.txt", plate.substr(sets) + "** another\n");
  EXPECT_NE(digest_of_abaqus(path), digest) << "of the files that are included, too";
  write("part.inp", "*INCLUDE, INPUT=nowhere.inp\n");
  expect_words(refusal([&path] { read_abaqus(path); }), {"part.inp:1", "nowhere.inp", "cannot be"});
  write("part.inp", "*INCLUDE, INPUT=part.inp\n");
  expect_words(refusal([&path] { read_abaqus(path); }), {"part.inp:1", "more than 200 files"});
  std::filesystem::remove_all(folder);
}

TEST(AbaqusFile, WhatIsWrongIsRefusedWithItsLine) {
  expect_words(refusal_of(""), {"part.inp:1", "no input file"});
  expect_words(refusal_of("$MeshFormat\n"), {"part.inp:1", "no input file", "gmsh"});
  expect_words(refusal_of("*NODE\n1, 0, 0, 0\n"), {"part.inp", "no solid elements"});
  expect_words(refusal_of(with("6, 2, 1", "5, 2, 1")), {"part.inp:9", "node 5 twice"});
  expect_words(refusal_of(with("12, 2,3", "11, 2,3")), {"part.inp:13", "element 11 twice"});
  expect_words(refusal_of(with("11, 1,2,5,4", "11, 1,2,5,8")),
               {"part.inp:12", "element 11 (CPS4) with node 8, which is not there"});
  expect_words(refusal_of(with("11, 1,2,5,4", "11, 1,2,1,4")),
               {"part.inp:12", "element 11 (CPS4) with node 1 twice", "a triangle"});
  expect_words(refusal_of(with("11, 1,2,5,4", "11, 1,2,5,4,6")),
               {"part.inp:12", "5 nodes in place of 4"});
  expect_words(refusal_of(with("TYPE=CPS4", "TYPE=S4R")), {"part.inp:11", "S4R", "Shells"});
  expect_words(refusal_of(with("TYPE=CPS4", "TYPE=CPE4T")), {"part.inp:11", "CPE4T", "C3D10"});
  expect_words(refusal_of(with("TYPE=CPS4, ", "")), {"part.inp:11", "*ELEMENT without TYPE"});
  expect_words(refusal_of(with("2e0", "two")), {"part.inp:5", "'two'", "a number"});
  expect_words(refusal_of(with("2e0", "1e999")), {"part.inp:5", "'1e999'"});
  expect_words(refusal_of(with("2e0", "nan")), {"part.inp:5", "'nan'"});
  expect_words(refusal_of(with("below, corners", "below, conrers")),
               {"part.inp:21", "'conrers'", "no set of nodes"});
  expect_words(refusal_of(with("Right One, S2", "Left One, S2")), {"part.inp:25", "'Left One'"});
  expect_words(refusal_of(with("Right One, S2", "Right One, S5")),
               {"part.inp:25", "S5 of element 12 (CPS4), which has 4"});
  expect_words(refusal_of(with("Right One, S2", "Right One, SPOS")), {"part.inp:25", "SPOS", "S1"});
  expect_words(refusal_of(with("6, 4\n", "6, 44\n")), {"part.inp:19", "node 44 in 'corners'"});
  expect_words(refusal_of(with("12\n*SURFACE", "*SURFACE")),
               {"part.inp:23", "'end', which has nothing in it"});
  expect_words(refusal_of(with("1, 3\n*NSET", "3, 1\n*NSET")), {"part.inp:16", "from 3 down to 1"});
  expect_words(refusal_of(with("1, 3\n*NSET", "70, 2000000000000\n*NSET")),
               {"part.inp:15", "'below', which has nothing in it"});
  expect_words(refusal_of(plate + "*NGEN\n1, 2\n"), {"*NGEN", "Write the mesh out"});
  expect_words(refusal_of(plate + "*PART, NAME=A\n"), {"within a *PART"});
  expect_words(refusal_of(with("part=square", "part=circle", assembly)),
               {"part.inp:18", "'circle', which is no *PART"});
  expect_words(refusal_of(with("3., 0., 1., 90.", "3., 0., 0., 90.", assembly)),
               {"'upper' about an axis without length"});
}

TEST(AbaqusFile, EveryTruncationIsAMeshOrRefused) {
  int refused = 0;
  for (const std::string& text : {plate, assembly}) {
    for (std::size_t size = 0; size < text.size(); ++size) {
      const std::string said =
          refusal([&] { check_mesh(mesh_of_text(text.substr(0, size)), "part.inp"); });
      refused += said != "not refused";
      if (said == "not refused") continue;
      EXPECT_EQ(said.rfind("part.inp", 0), 0u) << size << ": " << said;
    }
  }
  EXPECT_GT(refused, 800);  // assemblies have an end, and much of the first is nodes and elements
}

}  // namespace
}  // namespace abut::fe_abaqus_tests
