// Goal: Exodus files give the mesh that was written, and anything else is refused.
// Oracles: files of the Exodus library, and the nodes of sides as that library lists them.

#include <cstdio>
#include <fstream>
#include <functional>
#include <initializer_list>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/exodus_file.hpp"
#include "tests/support/mesh_measures.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::fe_exodus_tests {
namespace {

std::string path_of(const std::string& file) {
  return std::string(ABUT_SOURCE_DIR) + "/tests/data/exodus/" + file;
}

std::string bytes_of(const std::string& file) {
  std::ifstream stream(path_of(file), std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return bytes.str();
}

/// Whole numbers as NetCDF's classic format has them.
std::string big_endian(std::initializer_list<int> numbers) {
  std::string bytes;
  for (int number : numbers) bytes += std::string(3, '\0') + static_cast<char>(number);
  return bytes;
}

/// A file of these bytes, as long as this lives.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& bytes)
      : path_(testing::TempDir() + "abut_" +
              testing::UnitTest::GetInstance()->current_test_info()->name() + ".exo") {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  ~TemporaryFile() { std::remove(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  TemporaryFile(TemporaryFile&&) = delete;
  TemporaryFile& operator=(TemporaryFile&&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

class ExodusBlocks : public testing::TestWithParam<const char*> {};

TEST_P(ExodusBlocks, HaveTheirVolumesSidesAndSets) {
  const Mesh mesh = read_exodus(path_of(GetParam()));
  check_mesh(mesh, GetParam());
  const MeshMeasures measures(mesh);
  EXPECT_EQ(mesh.dim, 3);
  EXPECT_NEAR(measures.volume(), 6.0, roundoff(2000, 6.0));
  ASSERT_EQ(mesh.blocks.size(), 2u);
  EXPECT_EQ(mesh.blocks[0].name, "steel");
  EXPECT_EQ(mesh.blocks[1].name, "lead");
  const auto expect_area = [&measures](const char* side, int direction, double area) {
    const auto d = index(direction);
    EXPECT_NEAR(measures.surface(side).vector[d], area, roundoff(500, 6.0)) << side;
  };
  expect_area("bottom", 2, -2.0);
  expect_area("top", 2, 2.0);
  expect_area("surface_7", 1, -6.0);
  expect_area("behind", 1, 6.0);
  expect_area("left", 0, -3.0);
  expect_area("right", 0, 3.0);
  EXPECT_NEAR(measures.surface("boundary").area, 22.0, roundoff(2000, 22.0));
  EXPECT_FALSE(mesh.sides.contains("between"));
  for (std::int32_t n : mesh.nodes_of("edge")) {
    EXPECT_EQ(mesh.points[3 * n + 1], 0.0);
    EXPECT_EQ(mesh.points[3 * n + 2], 0.0);
  }
  EXPECT_EQ(mesh.nodes_of("nodelist_5"), (std::vector<std::int32_t>{0}));
}

TEST_P(ExodusBlocks, HaveTheNodesBetweenCornersWhereOurOrderPutsThem) {
  const Mesh mesh = read_exodus(path_of(GetParam()));
  for (const CellBlock& block : mesh.blocks) {
    const Element& element = *block.element;
    const auto nodes = index(element.nodes);
    const Element& linear = element_named(element.shape == Shape::hexahedron ? "hex8" : "tet4");
    for (std::size_t first = 0; first < block.nodes.size(); first += nodes) {
      for (std::size_t a = 0; a < nodes; ++a) {
        std::vector<double> n(index(linear.nodes)), dn(3 * n.size());
        linear.evaluate(std::span(element.corners).subspan(3 * a, 3), n, dn);
        for (std::size_t d = 0; d < 3; ++d) {
          double x = 0.0;
          for (std::size_t c = 0; c < n.size(); ++c)
            x += n[c] * mesh.points[3 * index(block.nodes[first + c]) + d];
          const double own = mesh.points[3 * index(block.nodes[first + a]) + d];
          EXPECT_EQ(own, x) << a;  // halves of whole numbers
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Files, ExodusBlocks,
                         testing::Values("block_hex20.exo", "block_hex20_netcdf4.exo",
                                         "block_tet10.exo"),
                         [](const testing::TestParamInfo<const char*>& item) {
                           const std::string name = item.param;
                           return name.substr(0, name.find('.'));
                         });

TEST(ExodusFile, SidesHaveTheNodesThatExodusListsForThem) {
  // what ex_get_side_set_node_list gives, counted from 1
  const auto expect_nodes = [](const Mesh& mesh, const char* side, std::size_t facet,
                               std::vector<std::int32_t> nodes) {
    for (std::int32_t& node : nodes) --node;
    EXPECT_EQ(mesh.nodes_of(mesh.side(side).at(facet)), nodes) << side;
  };
  const Mesh hex20 = read_exodus(path_of("block_hex20.exo"));
  expect_nodes(hex20, "bottom", 0, {1, 4, 3, 2, 12, 11, 10, 9});
  expect_nodes(hex20, "top", 1, {34, 45, 46, 35, 49, 50, 51, 42});
  expect_nodes(hex20, "surface_7", 3, {6, 23, 45, 34, 30, 47, 49, 38});
  expect_nodes(hex20, "left", 1, {5, 33, 36, 8, 37, 44, 40, 20});
  expect_nodes(hex20, "right", 0, {21, 22, 24, 23, 26, 29, 31, 28});
  expect_nodes(hex20, "behind", 2, {7, 8, 36, 35, 19, 40, 43, 39});
  const Mesh tet10 = read_exodus(path_of("block_tet10.exo"));
  expect_nodes(tet10, "bottom", 1, {1, 15, 3, 17, 16, 7});
  expect_nodes(tet10, "top", 0, {41, 32, 28, 43, 35, 44});
  expect_nodes(tet10, "surface_7", 0, {1, 2, 11, 5, 13, 12});
  expect_nodes(tet10, "left", 3, {23, 41, 37, 42, 45, 39});
  expect_nodes(tet10, "right", 3, {32, 11, 28, 34, 30, 35});
  const Mesh plate = read_exodus(path_of("plate.exo"));
  expect_nodes(plate, "left", 1, {10, 4, 13});
  expect_nodes(plate, "right", 0, {14, 15, 17});
  expect_nodes(plate, "top", 0, {9, 10, 12});
  expect_nodes(plate, "top", 1, {20, 9, 23});
}

TEST(ExodusFile, PlanePartsHaveTwoBlocksOfTheirOwnElements) {
  const Mesh mesh = read_exodus(path_of("plate.exo"), 1e-3);
  check_mesh(mesh, "plate.exo");
  EXPECT_NEAR(MeshMeasures(mesh).volume(), 6e-6, roundoff(500, 6e-6));
  ASSERT_EQ(mesh.blocks.size(), 2u);
  EXPECT_EQ(mesh.blocks[0].name, "block_1");
  EXPECT_EQ(mesh.blocks[0].element->name, "quad8");
  EXPECT_EQ(mesh.blocks[1].element->name, "tri6");
  EXPECT_EQ(mesh.sides.size(), 5u);  // with all of the boundary
  // the file's node set `left` is the side's nodes in another order: one name, one meaning
  EXPECT_FALSE(mesh.node_sets.contains("left"));
  EXPECT_EQ(mesh.nodes_of("left"), (std::vector<std::int32_t>{0, 3, 7, 9, 12}));
}

TEST(ExodusFile, WhatIsNoPartIsRefusedWithARemedy) {
  const auto of_change = [](const char* file, const std::string& old, const std::string& other) {
    std::string bytes = bytes_of(file);
    const std::size_t at = bytes.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    const TemporaryFile changed(bytes.replace(at, old.size(), other));
    return refusal([&changed]() { read_exodus(changed.path()); });
  };
  expect_words(of_change("block_hex20.exo", "HEX20", "WEDGE"),
               {"elements WEDGE of 20 nodes", "'steel'", "hexahedra"});
  expect_words(of_change("block_hex20.exo", "bottom", "behind"), {"two of ss_names", "'behind'"});
  expect_words(of_change("block_hex20.exo", "left", "edge"),
               {"a side and a node set called 'edge'", "different names"});
  expect_words(of_change("block_hex20.exo", "coordy", "coordi"), {"no variable coordy"});
  expect_words(of_change("block_hex20.exo", "num_nodes", "num_nobes"), {"no dimension num_nodes"});
  expect_words(refusal([]() { read_exodus(path_of("../gmsh/block.geo")); }),
               {"block.geo", "not a NetCDF file"});
  expect_words(refusal([]() { read_exodus(path_of("missing.exo")); }), {"cannot be opened"});
}

TEST(ExodusFile, SidesBothInsideAndOnTheBoundaryAndFacetsTwiceAreRefused) {
  // side 2 of element 2 of the list `right` {2, 4} becomes side 4: the facet to its neighbour
  const auto with_locals = [](const std::string& old, const std::string& other) {
    std::string bytes = bytes_of("block_hex20.exo");
    std::size_t at = bytes.find(old);
    EXPECT_NE(at, std::string::npos);
    const TemporaryFile changed(bytes.replace(at, old.size(), other));
    return refusal([&changed]() { read_exodus(changed.path()); });
  };
  const std::string right = big_endian({2, 4, 2, 2});  // elements, then their sides
  expect_words(with_locals(right, big_endian({2, 4, 4, 2})), {"'right'", "partly on the boundary"});
  expect_words(with_locals(right, big_endian({2, 2, 2, 2})), {"a facet twice", "'right'"});
  expect_words(with_locals(right, big_endian({2, 5, 2, 2})), {"number 5 in elem_ss6", "1 to 4"});
  expect_words(with_locals(right, big_endian({2, 4, 2, 7})), {"number 7 in side_ss6", "1 to 6"});
}

TEST(ExodusFile, EveryTruncationIsRefused) {
  for (const char* file : {"block_hex20.exo", "block_hex20_netcdf4.exo"}) {
    const std::string bytes = bytes_of(file);
    for (std::size_t size = 0; size < bytes.size(); size += size < 4000 ? 50 : 500) {
      const TemporaryFile cut(bytes.substr(0, size));
      const std::string text = refusal([&cut]() { check_mesh(read_exodus(cut.path()), "part"); });
      EXPECT_NE(text, "not refused") << file << " cut to " << size;
    }
  }
}

// Of the data alone: NetCDF 4.9.0 itself crashes on some damaged headers.
TEST(ExodusFile, DamagedDataGiveAMeshOrARefusalAndNothingElse) {
  std::mt19937 random(3);
  int refused = 0;
  const std::string bytes = bytes_of("block_hex20.exo");
  const std::size_t data = bytes.find(big_endian({1, 1, 10, 20}));  // eb_status and eb_prop1
  ASSERT_NE(data, std::string::npos);
  for (int k = 0; k < 1000; ++k) {
    std::string damaged = bytes;
    for (int change = 0; change < 1 + k % 3; ++change)
      damaged[data + random() % (damaged.size() - data)] = static_cast<char>(random() % 256);
    const TemporaryFile file(damaged);
    try {
      check_mesh(read_exodus(file.path()), "part");
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 200);  // much of so small a file is padding of names and unused fields
}

}  // namespace
}  // namespace abut::fe_exodus_tests
