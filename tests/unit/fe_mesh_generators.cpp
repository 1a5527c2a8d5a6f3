// Goal: generated parts have the size, the sides and the cells that were asked for.
// Oracles: closed forms of volumes (of the polygons and parabolas too), the divergence theorem.

#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/facet_index.hpp"
#include "subdomain_solver/fe/mesh_generators.hpp"
#include "tests/support/mesh_measures.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::fe_mesh_generators_tests {
namespace {

constexpr double pi = std::numbers::pi;

bool quadratic(const std::string& element) { return element_named(element).order == 2; }

/// The mesh passes check_mesh, its boundary is closed and holds its volume, and its named sides are
/// parts of the boundary.
void expect_sound(const Mesh& mesh) {
  EXPECT_NO_THROW(check_mesh(mesh, "mesh"));
  const MeshMeasures measures(mesh);
  const MeshMeasures::Surface skin = measures.surface("boundary");
  const double terms = 100.0 * mesh.cell_count();
  for (double sum : skin.vector) EXPECT_NEAR(sum, 0.0, roundoff(terms, skin.area));
  // coordinates are below 10 m
  EXPECT_NEAR(skin.flux, mesh.dim * measures.volume(), roundoff(terms, 10.0 * skin.area));
  const std::vector<Facet> boundary = FacetIndex(mesh).boundary();
  EXPECT_EQ(mesh.side("boundary"), boundary);
  std::set<std::tuple<int, int, int>> seen;
  for (const auto& [name, facets] : mesh.sides) {
    EXPECT_FALSE(facets.empty()) << name;
    if (name == "boundary") continue;
    for (const Facet& f : facets) EXPECT_TRUE(seen.insert({f.block, f.cell, f.local}).second);
  }
  EXPECT_EQ(seen.size(), boundary.size());
}

TEST(MeshGenerators, BarsHaveTheirLengthEndsAndGrading) {
  BarMesh data{.origin = -0.3, .length = 2.0, .elements = 5, .grading = 3.0};
  const Mesh mesh = generate(data, "mesh");
  expect_sound(mesh);
  EXPECT_NEAR(MeshMeasures(mesh).volume(), 2.0, roundoff(20, 2.0));
  EXPECT_EQ(mesh.nodes_of("left"), std::vector<std::int32_t>({0}));
  EXPECT_EQ(mesh.nodes_of("right"), std::vector<std::int32_t>({5}));
  EXPECT_EQ(mesh.points[0], -0.3);
  EXPECT_EQ(mesh.points[5], 1.7);
  EXPECT_NEAR((mesh.points[5] - mesh.points[4]) / (mesh.points[1] - mesh.points[0]), 3.0,
              roundoff(40, 3.0));
  const double ratio = (mesh.points[2] - mesh.points[1]) / (mesh.points[1] - mesh.points[0]);
  EXPECT_NEAR(ratio, std::pow(3.0, 0.25), roundoff(40, 2.0));
}

class PlaneParts : public testing::TestWithParam<const char*> {};
class SolidParts : public testing::TestWithParam<const char*> {};

TEST_P(PlaneParts, RectanglesHaveTheirAreaAndSides) {
  RectangleMesh data{.origin = {1.0, -2.0}, .lengths = {3.0, 0.5}, .elements = {4, 3}};
  data.grading = {2.0, 0.25};
  data.element = GetParam();
  for (Origin at : {Origin::corner, Origin::centre}) {
    data.origin_at = at;
    const Mesh mesh = generate(data, "mesh");
    expect_sound(mesh);
    const MeshMeasures measures(mesh);
    EXPECT_NEAR(measures.volume(), 1.5, roundoff(500, 1.5));
    EXPECT_NEAR(measures.surface("left").vector[0], -0.5, roundoff(100, 1.0));
    EXPECT_NEAR(measures.surface("right").vector[0], 0.5, roundoff(100, 1.0));
    EXPECT_NEAR(measures.surface("bottom").vector[1], -3.0, roundoff(100, 3.0));
    EXPECT_NEAR(measures.surface("top").vector[1], 3.0, roundoff(100, 3.0));
    EXPECT_EQ(mesh.cell_count(), element_named(data.element).shape == Shape::triangle ? 24 : 12);
    const std::int32_t corner = mesh.nodes_of("right_bottom").at(0);
    EXPECT_EQ(mesh.points[2 * corner], at == Origin::corner ? 4.0 : 2.5);
    EXPECT_EQ(mesh.points[2 * corner + 1], at == Origin::corner ? -2.0 : -2.25);
  }
}

TEST_P(PlaneParts, DisksAreBoundedByTheirPolygonOrItsParabolas) {
  const std::string element = GetParam();
  const double radius = 0.7;
  for (int core : {1, 2, 3, 6}) {
    DiskMesh data{.centre = {0.2, -0.1}, .radius = radius, .core = core, .layers = 2};
    data.element = element;
    const Mesh mesh = generate(data, "mesh");
    expect_sound(mesh);
    // equal angles: chords, and parabolas of their sagitta above them
    const double angle = pi / (2.0 * core);
    const double triangle = 0.5 * std::sin(angle);
    const double parabola = 4.0 / 3.0 * std::sin(0.5 * angle) * (1.0 - std::cos(0.5 * angle));
    const double area = 4.0 * core * (triangle + (quadratic(element) ? parabola : 0.0));
    const double exact = radius * radius * area;
    EXPECT_NEAR(MeshMeasures(mesh).volume(), exact, roundoff(100 * mesh.cell_count(), exact));
    if (core % 2 == 0) {
      const auto centre = index(mesh.nodes_of("centre").at(0));
      EXPECT_EQ(mesh.points[2 * centre], 0.2);
      EXPECT_EQ(mesh.points[2 * centre + 1], -0.1);
    }
    EXPECT_EQ(mesh.side("mantle").size(), index(4 * core));
  }
}

TEST_P(SolidParts, BoxesHaveTheirVolumeAndSides) {
  BoxMesh data{.origin = {1.0, -2.0, 0.5}, .lengths = {3.0, 0.5, 2.0}, .elements = {3, 2, 1}};
  data.grading = {2.0, 0.25, 5.0};
  data.element = GetParam();
  const Mesh mesh = generate(data, "mesh");
  expect_sound(mesh);
  const MeshMeasures measures(mesh);
  EXPECT_NEAR(measures.volume(), 3.0, roundoff(1000, 3.0));
  EXPECT_NEAR(measures.surface("left").vector[0], -1.0, roundoff(100, 1.0));
  EXPECT_NEAR(measures.surface("right").vector[0], 1.0, roundoff(100, 1.0));
  EXPECT_NEAR(measures.surface("bottom").vector[1], -6.0, roundoff(100, 6.0));
  EXPECT_NEAR(measures.surface("top").vector[1], 6.0, roundoff(100, 6.0));
  EXPECT_NEAR(measures.surface("back").vector[2], -1.5, roundoff(100, 1.5));
  EXPECT_NEAR(measures.surface("front").vector[2], 1.5, roundoff(100, 1.5));
  EXPECT_EQ(mesh.node_sets.size(), 8u);
  const auto corner = index(mesh.nodes_of("left_top_front").at(0));
  EXPECT_EQ(mesh.points[3 * corner], 1.0);
  EXPECT_EQ(mesh.points[3 * corner + 1], -1.5);
  EXPECT_EQ(mesh.points[3 * corner + 2], 2.5);
}

TEST_P(SolidParts, CylindersArePrismsOverTheirPolygonOrItsParabolas) {
  const std::string element = GetParam();
  for (int core : {1, 2, 3}) {
    CylinderMesh data{.origin = {0.0, 1.0, 2.0},
                      .radius = 0.5,
                      .length = 3.0,
                      .core = core,
                      .layers = 1,
                      .elements = 3,
                      .grading = 2.0};
    data.element = element;
    const Mesh mesh = generate(data, "mesh");
    expect_sound(mesh);
    const double angle = pi / (2.0 * core);
    const double triangle = 0.5 * std::sin(angle);
    const double parabola = 4.0 / 3.0 * std::sin(0.5 * angle) * (1.0 - std::cos(0.5 * angle));
    const double area = core * (triangle + (quadratic(element) ? parabola : 0.0));  // r^2 = 1/4
    const MeshMeasures measures(mesh);
    EXPECT_NEAR(measures.volume(), 3.0 * area, roundoff(100 * mesh.cell_count(), 3.0 * area));
    EXPECT_NEAR(measures.surface("top").vector[2], area, roundoff(1000, area));
    EXPECT_NEAR(measures.surface("bottom").vector[2], -area, roundoff(1000, area));
    if (core % 2 == 0) {
      const std::vector<std::int32_t> axis = mesh.nodes_of("axis");
      EXPECT_EQ(axis.size(), quadratic(element) ? 7u : 4u);
      for (std::int32_t n : axis) EXPECT_EQ(mesh.points[3 * index(n) + 1], 1.0);
    }
  }
}

TEST_P(SolidParts, RoundVolumesConvergeWithTheOrderOfTheirSurface) {
  const std::string element = GetParam();
  // a surface interpolated with order p lies within h^(p+1); for p = 2 symmetry adds one order
  const double order = quadratic(element) ? 4.0 : 2.0;
  double sphere[2], cylinder[2];
  for (int k : {0, 1}) {
    SphereMesh ball{.centre = {0.1, 0.2, 0.3}, .radius = 2.0, .core = 4 << k, .layers = 2 << k};
    ball.element = element;
    const Mesh of_ball = generate(ball, "mesh");
    expect_sound(of_ball);
    sphere[k] = MeshMeasures(of_ball).volume() - 4.0 / 3.0 * pi * 8.0;
    CylinderMesh rod{.radius = 2.0, .length = 1.0, .core = 4 << k, .layers = 2 << k};
    rod.elements = 2 << k;
    rod.element = element;
    const Mesh of_rod = generate(rod, "mesh");
    expect_sound(of_rod);
    cylinder[k] = MeshMeasures(of_rod).volume() - pi * 4.0;
  }
  // the next term of the error is h^2 smaller, h = pi / 8 at most: 5 % of an order
  EXPECT_NEAR(observed_order(sphere[0], sphere[1]), order, 0.15);
  EXPECT_NEAR(observed_order(cylinder[0], cylinder[1]), order, 0.15);
}

TEST_P(SolidParts, CoarseSpheresAreSound) {
  for (int core : {1, 2, 3}) {
    SphereMesh data{.radius = 1.0, .core = core, .layers = 1};
    data.element = GetParam();
    const Mesh mesh = generate(data, "mesh");
    expect_sound(mesh);
    if (core % 2 == 0) {
      EXPECT_EQ(mesh.nodes_of("centre").size(), 1u);
    }
  }
}

std::string name_of(const testing::TestParamInfo<const char*>& item) { return item.param; }
INSTANTIATE_TEST_SUITE_P(Elements, PlaneParts,
                         testing::Values("tri3", "tri6", "quad4", "quad8", "quad9"), name_of);
INSTANTIATE_TEST_SUITE_P(Elements, SolidParts, testing::Values("tet4", "tet10", "hex8", "hex20"),
                         name_of);

TEST(MeshGenerators, GiveTheSameMeshTwice) {
  SphereMesh data{.radius = 1.0, .core = 3, .layers = 2};
  data.element = "tet10";
  const Mesh a = generate(data, "mesh"), b = generate(data, "mesh");
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.blocks[0].nodes, b.blocks[0].nodes);
}

template <typename Data>
std::string refusal(const Data& data) {
  return abut::refusal([&data] { generate(data, "bodies.a.mesh"); });
}

TEST(MeshGenerators, RefuseWhatIsNoPart) {
  const BoxMesh good{.lengths = {1.0, 1.0, 1.0}, .elements = {1, 1, 1}};
  BoxMesh box = good;
  box.lengths[1] = 0.0;
  expect_words(refusal(box), {"bodies.a.mesh.lengths", "positive"});
  box = good;
  box.elements[2] = 0;
  expect_words(refusal(box), {"bodies.a.mesh.elements", "from 1 to"});
  box = good;
  box.elements = {20000, 20000, 20000};
  expect_words(refusal(box), {"coarser"});
  box = good;
  box.element = "quad4";
  expect_words(refusal(box), {"bodies.a.mesh.element", "hex20"});
  box = good;
  box.grading[0] = -1.0;
  expect_words(refusal(box), {"bodies.a.mesh.grading"});
  box = good;
  box.origin[0] = std::nan("");
  expect_words(refusal(box), {"bodies.a.mesh.origin", "finite"});
  expect_words(refusal(DiskMesh{.radius = -1.0, .core = 1, .layers = 1}), {"mesh.radius"});
  expect_words(refusal(DiskMesh{.radius = 1.0, .core = 1, .layers = 0}), {"mesh.layers"});
  expect_words(refusal(SphereMesh{.radius = 1.0, .core = 0, .layers = 1}), {"mesh.core"});
  expect_words(refusal(BarMesh{.length = 1.0, .elements = -1}), {"mesh.elements"});
  CylinderMesh rod{.radius = 1.0, .length = 1.0, .core = 1, .layers = 1, .elements = 1};
  rod.length = std::numeric_limits<double>::infinity();
  expect_words(refusal(rod), {"mesh.length", "finite"});
}

}  // namespace
}  // namespace abut::fe_mesh_generators_tests
