// Goal: a closed surface without cells is a tool, however its facets were drawn, and an open one is
// where it looks. Oracles: the same tool with cells; volumes; refusals that name the facet.

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "subdomain_solver/fe/gmsh_file.hpp"
#include "tests/support/mesh_measures.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/runs.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::surface_tools_tests {
namespace {

using Points = std::vector<std::array<double, 3>>;
using Facets = std::vector<std::vector<int>>;  // places among the points, from 0

/// A file in Gmsh's format with facets alone: the first two in the group "first", all others in
/// "rest".
std::string file_of(int dim, const Points& points, const Facets& facets) {
  const int own = dim - 1;
  std::string out = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n";
  out += fmt::format("{0} 1 \"first\"\n{0} 2 \"rest\"\n$EndPhysicalNames\n$Entities\n", own);
  out += own == 1 ? "0 2 0 0\n" : "0 0 2 0\n";
  for (const int tag : {1, 2}) out += fmt::format("{0} 0 0 0 1 1 1 1 {0} 0\n", tag);
  out += fmt::format("$EndEntities\n$Nodes\n1 {0} 1 {0}\n{1} 1 0 {0}\n", points.size(), own);
  for (std::size_t n = 1; n <= points.size(); ++n) out += fmt::format("{}\n", n);
  for (const auto& x : points) out += fmt::format("{} {} {}\n", x[0], x[1], x[2]);
  out += fmt::format("$EndNodes\n$Elements\n{0} {0} 1 {0}\n", facets.size());
  for (std::size_t e = 0; e < facets.size(); ++e) {
    const std::size_t nodes = facets[e].size();
    out += fmt::format("{} {} {} 1\n{}", own, e < 2 ? 1 : 2, nodes - 1, e + 1);
    for (const int node : facets[e]) out += fmt::format(" {}", node + 1);
    out += "\n";
  }
  return out + "$EndElements\n";
}

const Points square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
const Facets square_sides = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
const Points cube = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                     {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
/// The bottom in triangles.
const Facets cube_sides = {{0, 2, 3},    {0, 3, 1},    {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

/// Some of them drawn from the other side.
Facets turned(Facets facets, unsigned which) {
  for (std::size_t f = 0; f < facets.size(); ++f)
    if ((which >> f & 1u) != 0) std::ranges::reverse(facets[f]);
  return facets;
}

/// Outward, whatever the facets looked like.
TEST(SurfaceTools, ClosedSurfacesLookOutwards) {
  for (const int dim : {2, 3}) {
    const Points& points = dim == 2 ? square : cube;
    const Facets& facets = dim == 2 ? square_sides : cube_sides;
    for (unsigned which = 0; which < (1u << facets.size()); ++which) {
      const Mesh mesh =
          gmsh_mesh(file_of(dim, points, turned(facets, which)), "part.msh", 1.0, dim);
      check_mesh(mesh, "part.msh");
      const MeshMeasures measures(mesh);
      // The first group is the bottom, in the plane the bottom and the right side.
      const auto first = measures.surface("first").vector;
      EXPECT_NEAR(first[index(dim - 1)], -1.0, roundoff(100, 1.0));
      EXPECT_NEAR(first[0], dim == 2 ? 1.0 : 0.0, roundoff(100, 1.0));
      const auto all = measures.surface("boundary").vector;
      for (int i = 0; i < dim; ++i) EXPECT_NEAR(all[index(i)], 0.0, roundoff(100, 1.0));
    }
  }
}

TEST(SurfaceTools, OpenOnesLookAsTheirFirstFacet) {
  for (const bool back : {false, true}) {
    Facets facets = turned({{0, 1, 5, 4}, {1, 3, 7, 5}, {2, 3, 7, 6}}, back ? 0b011 : 0b010);
    const Mesh mesh = gmsh_mesh(file_of(3, cube, facets), "part.msh", 1.0, 3);
    const auto first = MeshMeasures(mesh).surface("first").vector;
    EXPECT_NEAR(first[1], back ? 1.0 : -1.0, roundoff(100, 1.0));
    EXPECT_NEAR(first[0], back ? -1.0 : 1.0, roundoff(100, 1.0));
  }
}

TEST(SurfaceTools, WhatHasNoSideIsRefusedWithTheFacet) {
  const auto said = [](const Facets& facets, const Points& points) {
    return refusal([&] { gmsh_mesh(file_of(3, points, facets), "part.msh", 1.0, 3); });
  };
  expect_words(said({{0, 1, 3}, {0, 1, 5}, {0, 1, 6}}, cube),
               {"part.msh", "element 3 (tri3)", "shares an edge with more than one other"});
  // A band of five triangles whose ends are joined the wrong way round (Moebius).
  const Facets band = {{0, 1, 2}, {1, 2, 3}, {2, 3, 4}, {3, 4, 0}, {4, 0, 1}};
  expect_words(said(band, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}, {0, 0, 1}}),
               {"element", "the surface has one side"});
  // As cells of a body that deforms it stays refused.
  expect_words(refusal([&] { gmsh_mesh(file_of(3, cube, cube_sides), "part.msh"); }), {"plane"});
}

/// A block that falls on a tool, by the tool's shape, with this side of it, from so far above [m].
ResultPtr fall(int dim, const std::string& shape, const std::string& side = "",
               double above = 0.01) {
  SolidText block{.name = "block",
                  .material =
                      "linear_elastic: {youngs_modulus: 1.0e6, poissons_ratio: 0.3, density: "
                      "1000.0}",
                  .integrator = "newmark: {step: 1.0e-3}",
                  .position = {0.35, 1.0 + above},
                  .velocity = {0.2, -1.0},
                  .side = "bottom",
                  .block = block_in(dim, {0.3, 0.3, 0.3}, {4, 4, 3})};
  if (dim == 3) {
    block.position = {0.35, 0.3, 1.0 + above};
    block.velocity = {0.2, 0.1, -1.0};
    block.side = "back";
  }
  if (!side.empty()) block.side = side;
  SolidText box{.name = "box",
                .dim = dim,
                .mesh = shape,
                .side = "boundary",
                .model = "rigid_tool",
                .keys = "step: 1.0e-3, way: [\"0.1 * t\", \"0.0\"" +
                        std::string(dim == 3 ? ", \"0.0\"], " : "], ")};
  return run_solids(0.05, 1.0e-3, {block, box},
                    "  fall: {sides: [block.face, box.face], contact: {friction: 0.3}}\n");
}

/// Drawn either way it is the same tool, bit for bit.
TEST(SurfaceTools, ThatEndSomewhereLookToWhoMayTouchThem) {
  const Points ends = {{1, 1, 0}, {0, 1, 0}};
  const std::string path = testing::TempDir() + "open_tool.msh";
  for (const char* side : {"bottom", "boundary"}) {
    std::vector<ResultPtr> drawn;
    for (const Facets& facets : {Facets{{0, 1}}, Facets{{1, 0}}}) {
      std::ofstream(path) << file_of(2, ends, facets);
      drawn.push_back(fall(2, "gmsh: {file: " + path + "}", side));
      ASSERT_TRUE(drawn.back()->completed()) << drawn.back()->end.reason;
    }
    EXPECT_GT(drawn[0]->measure("contact.fall.impulse"), 0.0) << side;
    for (const char* told :
         {"contact.fall.impulse", "body.block.momentum.x", "energy.total.relative_drift_max"})
      EXPECT_EQ(drawn[0]->measure(told), drawn[1]->measure(told)) << side << " " << told;
  }
}

/// Nodes that lie on a surface are on neither side of it: it looked inwards, and was overlapped.
TEST(SurfaceTools, LookToWhatLiesOnThem) {
  const std::string path = testing::TempDir() + "tool_below.msh";
  std::ofstream(path) << file_of(2, square, square_sides);
  for (const char* side : {"bottom", "boundary"}) {
    const auto run = fall(2, "gmsh: {file: " + path + "}", side, 0.0);
    ASSERT_TRUE(run->completed()) << run->end.reason;
    EXPECT_GT(run->measure("body.block.momentum.y"), 0.0) << side;  // it has bounced
  }
}

TEST(SurfaceTools, DoWhatToolsWithCellsDo) {
  for (const int dim : {2, 3}) {
    const std::string path = testing::TempDir() + fmt::format("surface_tool_{}.msh", dim);
    std::ofstream(path) << (dim == 2 ? file_of(2, square, turned(square_sides, 0b0101))
                                     : file_of(3, cube, turned(cube_sides, 0b0101101)));
    const auto alone = fall(dim, "gmsh: {file: " + path + "}");
    const auto cells = fall(
        dim, dim == 2 ? block_mesh({1.0, 1.0}, {1, 1}) : block_mesh({1.0, 1.0, 1.0}, {1, 1, 1}));
    ASSERT_TRUE(alone->completed()) << alone->end.reason;
    ASSERT_TRUE(cells->completed()) << cells->end.reason;
    EXPECT_GT(cells->measure("contact.fall.impulse"), 0.0);
    for (const char* axis : {"x", "y"}) {
      const std::string name = fmt::format("body.block.momentum.{}", axis);
      // Faces are flat: triangles say what quadrilaterals say, to the sweeps' tolerance.
      EXPECT_NEAR(alone->measure(name), cells->measure(name),
                  1.0e-7 * cells->measure("contact.fall.impulse"));
    }
  }
}

}  // namespace
}  // namespace abut::surface_tools_tests
