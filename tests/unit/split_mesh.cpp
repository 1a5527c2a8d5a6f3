// Goal: a mesh falls into connected parts that make up the whole, and files keep what they are of.
// Oracles: counts, volumes and areas; the file read back; the boundary of the parts.

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "coordinator/split/divided_mesh.hpp"
#include "coordinator/split/partition.hpp"
#include "subdomain_solver/fe/facet_index.hpp"
#include "subdomain_solver/fe/gmsh_file.hpp"
#include "subdomain_solver/fe/gmsh_text.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"
#include "tests/support/mesh_measures.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::split_mesh_tests {
namespace {

Mesh box(const std::string& element) {
  BoxMesh data;
  data.lengths = {1.0, 0.7, 1.9};
  data.elements = {4, 3, 6};
  data.element = element;
  return generate(data, "");
}

Mesh rectangle(const std::string& element) {
  RectangleMesh data;
  data.lengths = {2.0, 0.9};
  data.elements = {9, 5};
  data.element = element;
  return generate(data, "");
}

std::string data_file(const std::string& name) {
  return std::string(ABUT_SOURCE_DIR) + "/configs/meshes/" + name;
}

std::map<std::string, Mesh> meshes() {
  std::map<std::string, Mesh> all;
  for (const char* element : {"quad4", "quad8", "tri3", "tri6"}) all[element] = rectangle(element);
  for (const char* element : {"hex8", "hex20", "tet4", "tet10"}) all[element] = box(element);
  CylinderMesh round;
  round.radius = 0.5;
  round.length = 1.0;
  round.core = round.layers = 2;
  round.elements = 4;
  all["cylinder"] = generate(round, "");
  all["gear"] = read_gmsh(data_file("gear_12.msh"));
  all["bolt"] = read_gmsh(data_file("bolt.msh"));
  return all;
}

std::set<std::vector<std::int32_t>> facets_of(const Mesh& mesh, const std::string& side) {
  std::set<std::vector<std::int32_t>> all;
  for (const Facet& facet : mesh.side(side)) all.insert(mesh.nodes_of(facet));
  return all;
}

TEST(GmshText, ReadsBackToTheSameMesh) {
  for (const auto& [name, mesh] : meshes()) {
    SCOPED_TRACE(name);
    const Mesh back = gmsh_mesh(gmsh_text(mesh), name);
    EXPECT_EQ(back.dim, mesh.dim);
    EXPECT_EQ(back.points, mesh.points);                                // to the bit
    std::map<std::string_view, std::vector<std::int32_t>> cells, read;  // blocks of a type are one
    for (const auto& [from, to] : {std::pair(&mesh, &cells), {&back, &read}})
      for (const CellBlock& block : from->blocks)
        (*to)[block.element->name].insert((*to)[block.element->name].end(), block.nodes.begin(),
                                          block.nodes.end());
    EXPECT_EQ(read, cells);
    EXPECT_EQ(back.node_sets, mesh.node_sets);
    ASSERT_EQ(back.sides.size(), mesh.sides.size());
    for (const auto& [side, facets] : mesh.sides)
      EXPECT_EQ(facets_of(back, side), facets_of(mesh, side)) << side;
  }
}

std::vector<MeshPart> parts_of(const Mesh& mesh, int count,
                               const std::vector<std::int32_t>& whole = {}) {
  std::vector<std::string> names;
  for (int p = 0; p < count; ++p) names.push_back(fmt::format("part_{}", p));
  const CellGraph graph = cell_graph(mesh);
  return divide(mesh, graph, partition(graph, kept_together(mesh, whole), count, "mesh"), names,
                "mesh");
}

/// Nodes of a part's cells in the whole mesh.
std::vector<std::int32_t> in_whole(const MeshPart& part, std::vector<std::int32_t> nodes) {
  for (std::int32_t& node : nodes) node = part.nodes[node];
  return nodes;
}

TEST(DividedMesh, HasEveryCellOnceAndItsSides) {
  for (const auto& [name, mesh] : meshes()) {
    for (const int count : {2, 3, 4, 7}) {
      SCOPED_TRACE(fmt::format("{} {}", name, count));
      const std::vector<MeshPart> parts = parts_of(mesh, count);
      std::multiset<std::vector<std::int32_t>> whole, divided;
      for (const CellBlock& block : mesh.blocks)
        for (int c = 0; c < block.count(); ++c) {
          const auto nodes = nodes_of(block, c);
          whole.emplace(nodes.begin(), nodes.end());
        }
      double volume = 0.0;
      std::map<std::string, std::size_t> facets;
      for (const MeshPart& part : parts) {
        check_mesh(part.mesh, name);
        volume += MeshMeasures(part.mesh).volume();
        for (const CellBlock& block : part.mesh.blocks)
          for (int c = 0; c < block.count(); ++c) {
            const auto nodes = nodes_of(block, c);
            divided.insert(in_whole(part, {nodes.begin(), nodes.end()}));
          }
        for (const auto& [side, own] : part.mesh.sides) facets[side] += own.size();
      }
      EXPECT_EQ(divided, whole);
      const double exact = MeshMeasures(mesh).volume();
      EXPECT_NEAR(volume, exact, roundoff(64 * mesh.cell_count(), exact));
      for (const auto& [side, own] : mesh.sides) EXPECT_EQ(facets[side], own.size()) << side;
    }
  }
}

TEST(DividedMesh, PartsAreConnectedAndOfLikeSize) {
  for (const auto& [name, mesh] : meshes()) {
    for (const int count : {2, 3, 4}) {
      SCOPED_TRACE(fmt::format("{} {}", name, count));
      for (const MeshPart& part : parts_of(mesh, count)) {
        const CellGraph graph = cell_graph(part.mesh);
        const std::vector<int> piece = pieces_of(graph, std::vector<int>(index(graph.cells()), 0));
        EXPECT_EQ(*std::ranges::max_element(piece), 0);
        // METIS allows 3 %, and a cell more where there are few.
        EXPECT_LE(part.mesh.cell_count(), 1.03 * mesh.cell_count() / count + 2.0);
      }
    }
  }
}

/// The cuts are all that the parts' boundaries have beside that of the whole, and look alike from
/// both sides.
TEST(DividedMesh, CutsCloseTheParts) {
  for (const auto& [name, mesh] : meshes()) {
    SCOPED_TRACE(name);
    const std::vector<MeshPart> parts = parts_of(mesh, 4);
    std::size_t cut = 0, outside = 0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      outside += FacetIndex(parts[p].mesh).boundary().size();
      for (const auto& [other, side] : parts[p].towards) {
        const MeshPart& partner = parts[other];
        const auto places = [](const MeshPart& part, const std::string& of) {
          std::set<std::set<std::int32_t>> all;
          for (const Facet& facet : part.mesh.side(of)) {
            const std::vector<std::int32_t> nodes = in_whole(part, part.mesh.nodes_of(facet));
            all.emplace(nodes.begin(), nodes.end());
          }
          return all;
        };
        EXPECT_EQ(places(parts[p], side), places(partner, partner.towards.at(static_cast<int>(p))));
        cut += parts[p].mesh.side(side).size();
      }
    }
    EXPECT_EQ(outside, cut + FacetIndex(mesh).boundary().size());
  }
}

/// No node of such a surface lies on a cut.
TEST(DividedMesh, LeavesSurfacesWholeThatMayTouch) {
  for (const char* element : {"quad4", "tri3", "hex8", "tet4"}) {
    SCOPED_TRACE(element);
    const Mesh mesh = meshes().at(element);
    const std::vector<std::int32_t> top = mesh.nodes_of("top");
    int with = 0;
    for (const MeshPart& part : parts_of(mesh, 3, top)) {
      with += part.mesh.sides.contains("top");
      for (const auto& [other, side] : part.towards) {
        std::vector<std::int32_t> common;
        const std::vector<std::int32_t> cut = in_whole(part, part.mesh.nodes_of(side));
        std::ranges::set_intersection(cut, top, std::back_inserter(common));
        EXPECT_TRUE(common.empty());
      }
    }
    EXPECT_EQ(with, 1);
  }
}

TEST(DividedMesh, IsTheSameEveryTime) {
  for (const auto& [name, mesh] : meshes()) {
    const std::vector<MeshPart> one = parts_of(mesh, 3), other = parts_of(mesh, 3);
    for (std::size_t p = 0; p < one.size(); ++p)
      EXPECT_EQ(gmsh_text(one[p].mesh), gmsh_text(other[p].mesh)) << name;
  }
}

TEST(DividedMesh, RefusesWhatWouldComeApart) {
  const Mesh pieces = read_gmsh(data_file("two_pieces.msh"));
  EXPECT_NE(refusal([&] { parts_of(pieces, 2); }).find("is of 2 pieces that share no facets"),
            std::string::npos);
  const Mesh mesh = rectangle("quad4");
  EXPECT_NE(refusal([&] { parts_of(mesh, 46); }).find("has 45 cells to deal out"),
            std::string::npos);
  // A ring of four squares around a hole, closed at a corner that two of them share and no facet.
  Mesh ring;
  ring.dim = 2;
  ring.points = {0, 0, 1, 0, 2, 0, 0, 1, 1, 1, 2, 1, 0, 2, 1, 2, 3, 1, 3, 0};
  ring.blocks = {
      {&element_named("quad4"), {0, 1, 4, 3, 3, 4, 7, 6, 1, 2, 5, 4, 2, 9, 8, 5}, "", {}}};
  const CellGraph graph = cell_graph(ring);
  const std::vector<std::string> names = {"a", "b"};
  EXPECT_EQ(divide(ring, graph, {0, 0, 1, 1}, names, "mesh").size(), 2u);
  Mesh bow = ring;  // two squares at a corner, held together by nothing else
  bow.points = {0, 0, 1, 0, 1, 1, 0, 1, 2, 1, 2, 2, 1, 2};
  bow.blocks = {{&element_named("quad4"), {0, 1, 2, 3, 2, 4, 5, 6}, "", {}}};
  EXPECT_NE(refusal([&] {
              divide(bow, cell_graph(bow), {0, 1}, names, "mesh");
            }).find("would come apart at (1, 1) m"),
            std::string::npos);
}

}  // namespace
}  // namespace abut::split_mesh_tests
