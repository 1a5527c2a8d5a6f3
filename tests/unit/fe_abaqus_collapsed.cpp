// Goal: elements of input files whose nodes repeat are the shapes that they have collapsed to,
// whichever edges or faces these are; cells that are wrong are named with their lines.
// Oracles: volumes and faces of these shapes in closed form, for all turns of a hexahedron; the
// same mesh written in elements of those shapes.

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "base/index.hpp"
#include "subdomain_solver/fe/abaqus_file.hpp"
#include "tests/support/mesh_measures.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::fe_abaqus_collapsed_tests {
namespace {

using Point = std::array<double, 3>;
using Edge = std::array<int, 2>;

// As the manuals have them, counted from 0: edges with their middle nodes in turn, and faces.
const std::vector<Edge> edges = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                 {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
const std::vector<std::vector<int>> faces = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                             {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
const std::vector<Point> cube = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                 {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

/// Where each corner goes in a turn of the cube onto itself.
std::vector<std::vector<int>> turns() {
  std::vector<std::vector<int>> all;
  std::array<int, 3> axes = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      const int swaps = (axes[0] > axes[1]) + (axes[0] > axes[2]) + (axes[1] > axes[2]);
      const int mirrored = (signs & 1) + (signs >> 1 & 1) + (signs >> 2 & 1);
      if ((swaps + mirrored) % 2 != 0) continue;
      std::vector<int>& turn = all.emplace_back();
      for (const Point& x : cube) {
        Point to{};
        for (std::size_t d = 0; d < 3; ++d)
          to[d] = (signs >> d & 1) != 0 ? 1.0 - x[index(axes[d])] : x[index(axes[d])];
        turn.push_back(static_cast<int>(std::ranges::find(cube, to) - cube.begin()));
      }
    }
  } while (std::ranges::next_permutation(axes).found);
  return all;
}

struct Collapsed {
  double volume;
  std::vector<int> nodes;  // of the points below, for the corners of a hexahedron
  std::vector<Point> points;
};

const std::vector<Point> box = {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0},
                                {0, 0, 4}, {2, 0, 4}, {2, 3, 4}, {0, 3, 4}};
const std::vector<Collapsed> shapes = {
    {12.0, {0, 1, 2, 2, 4, 5, 6, 6}, box},  // prism
    {8.0, {0, 1, 2, 3, 4, 4, 4, 4}, {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}, {1, 1, 4}}},
    {4.0, {0, 1, 2, 2, 3, 3, 3, 3}, {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 4}}},  // tetrahedron
};

Point middle_of(const std::vector<Point>& points, int a, int b) {
  Point middle{};
  for (std::size_t d = 0; d < 3; ++d) middle[d] = 0.5 * (points[index(a)][d] + points[index(b)][d]);
  return middle;
}

/// A file of one hexahedron with these corners, each of its faces a surface.
std::string text_of(const std::vector<int>& corners, std::vector<Point> points, bool quadratic) {
  std::vector<int> nodes = corners;
  std::vector<std::pair<std::set<int>, int>> middles;
  for (const Edge& edge : edges) {
    const int a = corners[index(edge[0])], b = corners[index(edge[1])];
    const auto known =
        std::ranges::find(middles, std::set<int>{a, b}, &std::pair<std::set<int>, int>::first);
    if (!quadratic) break;
    if (a == b) {
      nodes.push_back(a);
    } else if (known != middles.end()) {
      nodes.push_back(known->second);
    } else {
      nodes.push_back(static_cast<int>(points.size()));
      middles.emplace_back(std::set<int>{a, b}, nodes.back());
      points.push_back(middle_of(points, a, b));
    }
  }
  std::string text = "*Node\n";
  for (std::size_t n = 0; n < points.size(); ++n)
    text += fmt::format("{}, {}, {}, {}\n", n + 1, points[n][0], points[n][1], points[n][2]);
  text += fmt::format("*Element, type=C3D{}, elset=All\n7", nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n)
    text += fmt::format(",{}{}", n == 9 ? "\n" : " ", nodes[n] + 1);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    std::set<int> own;
    for (const int corner : faces[f]) own.insert(corners[index(corner)]);
    if (own.size() > 2)
      text += fmt::format("\n*Surface, type=ELEMENT, name=face_{}\n All, S{}", f, f + 1);
  }
  return text + "\n";
}

/// Places of a side's nodes that are corners of the element.
std::set<Point> places_of(const Mesh& mesh, const std::string& side,
                          const std::vector<Point>& points) {
  std::set<Point> places;
  for (const std::int32_t node : mesh.nodes_of(side)) {
    Point at{};
    std::copy_n(mesh.points.begin() + std::ptrdiff_t{3} * node, 3, at.begin());
    if (std::ranges::find(points, at) != points.end()) places.insert(at);
  }
  return places;
}

Mesh mesh_of_text(const std::string& text, std::vector<std::string>* notes = nullptr) {
  return abaqus_mesh(text, "part.inp", 1.0, "", 0, notes);
}

TEST(CollapsedElements, HaveVolumesAndFacesOfTheirShapesInAllTurns) {
  const std::vector<std::vector<int>> all = turns();
  ASSERT_EQ(all.size(), 24u);
  for (const Collapsed& shape : shapes) {
    for (const std::vector<int>& turn : all) {
      for (const bool quadratic : {false, true}) {
        std::vector<int> corners;
        for (const int to : turn) corners.push_back(shape.nodes[index(to)]);
        SCOPED_TRACE(fmt::format("{} {}", fmt::join(corners, ","), quadratic));
        const Mesh mesh = mesh_of_text(text_of(corners, shape.points, quadratic));
        check_mesh(mesh, "part.inp");
        // sums over some points of up to three cells
        EXPECT_NEAR(MeshMeasures(mesh).volume(), shape.volume, roundoff(2000, shape.volume));
        for (std::size_t f = 0; f < faces.size(); ++f) {
          std::set<Point> expected;
          for (const int corner : faces[f])
            expected.insert(shape.points[index(corners[index(corner)])]);
          const std::string name = fmt::format("face_{}", f);
          ASSERT_EQ(mesh.sides.contains(name), expected.size() > 2) << name;
          if (expected.size() > 2) EXPECT_EQ(places_of(mesh, name, shape.points), expected) << name;
        }
      }
    }
  }
}

const std::string nodes =
    "*NODE\n1, 0, 0\n2, 2, 0\n3, 2, 3\n4, 0, 3\n5, 0, 0, 4\n6, 2, 0, 4\n7, 2, 3, 4\n8, 0, 3, 4\n"
    "9, 3, 3, 0\n10, 3, 3, 4\n";

TEST(CollapsedElements, AreTheElementsOfTheirShapes) {
  std::vector<std::string> notes;
  const std::string surface = "*SURFACE, NAME=free\nALL\n";
  const Mesh collapsed = mesh_of_text(
      nodes + "*ELEMENT, TYPE=C3D8, ELSET=ALL\n1, 1,2,3,4,5,6,7,8\n2, 2,9,3,3,6,10,7,7\n" + surface,
      &notes);
  const Mesh written = mesh_of_text(nodes +
                                    "*ELEMENT, TYPE=C3D8, ELSET=ALL\n1, 1,2,3,4,5,6,7,8\n"
                                    "*ELEMENT, TYPE=C3D6, ELSET=ALL\n2, 2,9,3,6,10,7\n" +
                                    surface);
  EXPECT_EQ(collapsed.points, written.points);
  ASSERT_EQ(collapsed.blocks.size(), 1u);
  EXPECT_EQ(collapsed.blocks[0].nodes, written.blocks[0].nodes);
  EXPECT_EQ(collapsed.sides.at("free").size(), written.sides.at("free").size());
  EXPECT_EQ(collapsed.nodes_of("free"), written.nodes_of("free"));
  ASSERT_FALSE(notes.empty());
  EXPECT_EQ(notes.front(), "of elements with repeated nodes: 1 prism");
}

TEST(CollapsedElements, OfThePlaneAreTriangles) {
  const std::string plate = "*NODE\n1, 0, 0\n2, 2, 0\n3, 2, 3\n4, 1, 0\n5, 2, 1.5\n6, 1, 1.5\n";
  for (const char* element : {"CPS4\n1, 1,2,3,3", "CPS4\n1, 1,1,2,3", "CPE8\n1, 1,2,3,3,4,5,3,6"}) {
    const Mesh mesh = mesh_of_text(plate + "*ELEMENT, ELSET=ALL, TYPE=" + element +
                                   "\n*SURFACE, NAME=free\nALL\n");
    check_mesh(mesh, "part.inp");
    EXPECT_NEAR(MeshMeasures(mesh).volume(), 3.0, roundoff(100, 3.0)) << element;
    EXPECT_EQ(mesh.sides.at("free").size(), 3u) << element;
  }
}

TEST(CollapsedElements, OfNoShapeAreRefusedWithTheirLine) {
  const auto refused = [](const std::string& element) {
    return refusal([&] { mesh_of_text(nodes + "*ELEMENT, TYPE=C3D8\n1, " + element + "\n"); });
  };
  for (const char* element : {"1,2,3,3,5,6,7,8", "1,2,1,4,5,6,7,8", "1,2,3,4,5,6,5,8",
                              "1,2,3,3,5,5,7,8", "1,1,1,1,5,5,5,5"})
    expect_words(refused(element), {"part.inp:13", "element 1 (C3D8) with node", "twice", "prism"});
  const std::string middle = refusal([] {
    mesh_of_text(
        "*NODE\n1, 0, 0\n2, 2, 0\n3, 2, 3\n4, 1, 0\n5, 2, 1.5\n6, 1, 1.5\n7, 2, 3.1\n"
        "*ELEMENT, TYPE=CPE8\n1, 1,2,3,3,4,5,7,6\n");
  });
  expect_words(middle, {"part.inp:10", "node 3 twice", "middle nodes"});
}

TEST(AbaqusCells, ThatAreInvertedAreNamedWithTheirLines) {
  CellWords words;
  const std::string text = nodes +
                           "*ELEMENT, TYPE=C3D8\n1, 1,2,3,4,5,6,7,8\n"
                           "*ELEMENT, TYPE=C3D6\n22, 3,9,2,7,10,6\n";
  const Mesh mesh = abaqus_mesh(text, "part.inp", 1.0, "", 0, nullptr, &words);
  const std::string said = refusal([&] { check_mesh(mesh, "bodies.a", words); });
  // the prism is three of the nine tetrahedra at least
  expect_words(said, {"bodies.a", "inverted", "element 22, part.inp:15", "Jacobian"});
}

}  // namespace
}  // namespace abut::fe_abaqus_collapsed_tests
