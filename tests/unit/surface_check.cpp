// Goal: every way in which a surface can be unsound is named with its facet.
// Oracle: the words, and silence for what is sound.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <string>

#include "base/index.hpp"
#include "surface/check.hpp"
#include "tests/support/surfaces.hpp"

namespace abut::surface_check_tests {
namespace {

/// Two squares and a triangle side by side.
SurfaceMesh three_facets() {
  SurfaceMesh mesh;
  mesh.points = {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0, 3, 0, 0};
  mesh.add_facet({0, 1, 4, 3}, false);
  mesh.add_facet({1, 2, 5, 4}, false);
  mesh.add_facet({2, 6, 5}, false);
  return mesh;
}

std::string verdict(const SurfaceMesh& mesh) {
  const std::optional<UnsoundSurface> unsound = check(mesh.pose());
  return unsound ? words(*unsound) : "";
}

TEST(SurfaceCheck, NamesTheDefectAndItsFacet) {
  const auto spoilt = [](const std::function<void(SurfaceMesh&)>& spoil) {
    SurfaceMesh mesh = three_facets();
    spoil(mesh);
    return verdict(mesh);
  };
  EXPECT_EQ(verdict(three_facets()), "");
  EXPECT_EQ(verdict(SurfaceMesh{}), "");
  EXPECT_EQ(spoilt([](SurfaceMesh& m) { m.dim = 1; }),
            "the surface is neither in the plane nor in space");
  EXPECT_EQ(spoilt([](SurfaceMesh& m) { m.points.pop_back(); }),
            "the surface has no whole number of points");
  EXPECT_EQ(spoilt([](SurfaceMesh& m) { m.offsets.back() = 10; }),
            "the surface has offsets that do not grow from 0 to the list's end");
  EXPECT_EQ(spoilt([](SurfaceMesh& m) {
              m.offsets = {0, 8, 4, 11};
            }),
            "facet 1 has offsets that do not grow from 0 to the list's end");
  EXPECT_EQ(spoilt([](SurfaceMesh& m) {
              m.offsets = {0, 4, 9, 11};
            }),
            "facet 1 has a wrong number of nodes");
  EXPECT_EQ(spoilt([](SurfaceMesh& m) { m.facets[4] = 7; }),
            "facet 1 has a node that is not there");
  EXPECT_EQ(spoilt([](SurfaceMesh& m) { m.facets[4] = -1; }),
            "facet 1 has a node that is not there");
  EXPECT_EQ(spoilt([](SurfaceMesh& m) { m.facets[10] = 2; }), "facet 2 has a node twice");
  EXPECT_EQ(spoilt([](SurfaceMesh& m) { m.points[19] = std::numeric_limits<double>::infinity(); }),
            "facet 2 has a node whose coordinates are not finite");
  EXPECT_EQ(spoilt([](SurfaceMesh& m) { m.points[18] = 2.0; }), "facet 2 has no area");
  EXPECT_EQ(
      spoilt([](SurfaceMesh& m) { std::reverse(m.facets.begin() + 4, m.facets.begin() + 8); }),
      "facet 1 looks the other way than its neighbour");
  EXPECT_EQ(spoilt([](SurfaceMesh& m) { m.points[0] = 2.0, m.points[1] = 2.0; }),
            "facet 0 is not convex");
  EXPECT_EQ(spoilt([](SurfaceMesh& m) { std::swap(m.facets[5], m.facets[6]); }),
            "facet 1 has no area");  // a bow
}

/// Divided along the diagonal from the corner that points inward, both triangles look as the whole
/// does, and have its area together.
TEST(SurfaceCheck, DividesAQuadrilateralThatIsNotConvex) {
  const Eigen::Vector3d x[] = {{0, 0, 0}, {1, 0, 0}, {0.25, 0.25, 0}, {0, 1, 0}};
  for (int first = 0; first < 4; ++first) {
    Corners arrow{4, {}};
    for (int i = 0; i < 4; ++i) arrow.x[index((first + i) % 4)] = x[i];
    const auto parts = unfolding(arrow);
    ASSERT_TRUE(parts.has_value());
    double sum = 0.0;
    for (const std::array<int, 3>& part : *parts) {
      Corners triangle{3, {}};
      for (std::size_t i = 0; i < 3; ++i) triangle.x[i] = arrow.x[index(part[i])];
      EXPECT_GT(area_vector(triangle).z(), 0.0);
      sum += area_vector(triangle).z();
    }
    EXPECT_DOUBLE_EQ(sum, area_vector(arrow).z());
    arrow.x[index((first + 2) % 4)] = {1, 1, 0};
    EXPECT_FALSE(unfolding(arrow).has_value()) << "convex";
  }
}

/// One whose mean plane sees it cross itself is divided where its halves turn less.
TEST(SurfaceCheck, DividesAQuadrilateralThatIsFoldedOverBothDiagonals) {
  const Corners warped{
      4, {{{-0.04, -0.13, 0.29}, {0.03, -0.2, 0.59}, {0.03, 0.1, 0.4}, {-0.03, 0.2, 0.55}}}};
  const auto parts = unfolding(warped);
  ASSERT_TRUE(parts.has_value());
  const auto turn = [&warped](const std::array<std::array<int, 3>, 2>& halves) {
    std::array<Eigen::Vector3d, 2> normals;
    for (std::size_t k : {0u, 1u}) {
      Corners triangle{3, {}};
      for (std::size_t i = 0; i < 3; ++i) triangle.x[i] = warped.x[index(halves[k][i])];
      normals[k] = area_vector(triangle).normalized();
    }
    return normals[0].dot(normals[1]);
  };
  const double one = turn({{{0, 1, 2}, {0, 2, 3}}}), other = turn({{{1, 2, 3}, {1, 3, 0}}});
  EXPECT_EQ(turn(*parts), std::max(one, other));
  const Corners bow{4, {{{0, 0, 0}, {1, 0, 0}, {0.2, 1, 0}, {0.8, 1, 0}}}};
  EXPECT_FALSE(unfolding(bow).has_value());
}

TEST(SurfaceCheck, KnowsSegments) {
  const auto segments = [](std::vector<double> points, std::vector<std::int32_t> nodes) {
    SurfaceMesh mesh;
    mesh.dim = 2;
    mesh.points = std::move(points);
    mesh.add_facet(std::move(nodes), false);
    return verdict(mesh);
  };
  EXPECT_EQ(segments({0, 0, 1, 0}, {0, 1}), "");
  EXPECT_EQ(segments({0, 0, 0, 0}, {0, 1}), "facet 0 has no area");
  EXPECT_EQ(segments({0, 0, 1, 0, 0, 1}, {0, 1, 2}), "facet 0 has a wrong number of nodes");
}

}  // namespace
}  // namespace abut::surface_check_tests
