// Goal: edges that pass through facets are found, also exactly through nodes and edges between
// facets, and nothing that only touches.
// Oracles: surfaces that meet or touch by construction; for drawn ones linear equations.

#include "surface/intersections.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "tests/support/feature_cases.hpp"

namespace abut::surface_intersections_tests {
namespace {

using Vector = Eigen::Vector3d;

constexpr double depth = 1e-9;  // far above the rounding of places of size 3

std::vector<Intersection> found_in(const std::vector<SurfaceMesh>& meshes, bool themselves = false,
                                   double by = depth) {
  const Skin skin = skin_of(meshes);
  const std::vector<Vector> points = points_of(meshes);
  SkinTrees trees(skin, points);
  FeatureChoice choice;
  if (themselves) choice.allowed.assign(meshes.size() * meshes.size(), 1);
  std::vector<Intersection> found;
  intersections(trees, points, by, choice, found);
  return found;
}

/// Blocks beside and on each other, turned as a whole so that no number is exact: flush, shifted by
/// half and by a bit, smaller and larger, touching in faces, edges and corners.
TEST(Intersections, AreNoneOfBlocksThatTouch) {
  for (const int dim : {2, 3}) {
    for (const bool turned : {false, true}) {
      const Eigen::Matrix3d turn = !turned ? Eigen::Matrix3d::Identity()
                                   : dim == 3
                                       ? some_rotation()
                                       : Eigen::AngleAxisd(0.7, Vector::UnitZ()).toRotationMatrix();
      for (const double x : {-1.0, -0.5, -0.1, 0.0, 0.3, 1.0}) {
        for (const double y : {-1.0, -0.5, 0.0, 0.3, 1.0}) {
          for (const double size : {0.4, 1.0, 2.0}) {
            if (dim == 2 && y != 0.0) continue;
            const Vector low = dim == 2 ? Vector(x, 1, 0) : Vector(x, y, 1);
            const std::vector<SurfaceMesh> meshes{
                moved(block(dim, {0, 0, 0}, {1, 1, 1}), turn, {0.1, 0.2, 0.3}),
                moved(block(dim, low, low + size * Vector(1, 1, 1)), turn, {0.1, 0.2, 0.3})};
            EXPECT_TRUE(found_in(meshes).empty()) << dim << " " << x << " " << y << " " << size;
          }
        }
      }
    }
  }
}

/// A block that fits between two walls touches both.
TEST(Intersections, AreNoneOfABlockInATightGap) {
  for (const int dim : {2, 3}) {
    SurfaceMesh walls = block(dim, {-1, 0, 0}, {0, 1, 1});
    const SurfaceMesh other = block(dim, {1, 0, 0}, {2, 1, 1});
    const std::int32_t nodes = walls.nodes();
    walls.points.insert(walls.points.end(), other.points.begin(), other.points.end());
    for (int f = 0; f < other.pose().facet_count(); ++f) {
      std::vector<std::int32_t> facet;
      for (const std::int32_t n : other.pose().nodes(f)) facet.push_back(nodes + n);
      walls.add_facet(facet, false);
    }
    for (const double from : {0.0, 0.2, 0.5})
      EXPECT_TRUE(
          found_in({walls, block(dim, {0, from, from}, {1, from + 0.7, from + 0.5})}).empty());
    EXPECT_FALSE(found_in({walls, block(dim, {-0.01, 0.2, 0.2}, {1, 0.7, 0.7})}).empty());
  }
}

TEST(Intersections, AreFoundOnceBlocksOverlapByMoreThanTheDepth) {
  for (const int dim : {2, 3}) {
    for (const double overlap : {1e-3, 1e-6, 1e-8}) {
      const auto above = [&](double by) {
        return std::vector<SurfaceMesh>{
            block(dim, {0, 0, 0}, {1, 1, 1}),
            block(dim, dim == 2 ? Vector(0.3, 1 - by, 0) : Vector(0.3, 0.3, 1 - by),
                  dim == 2 ? Vector(1.6, 2, 0) : Vector(1.6, 1.6, 2))};
      };
      EXPECT_FALSE(found_in(above(overlap)).empty());
      EXPECT_TRUE(found_in(above(overlap), false, 2.0 * overlap).empty());
      EXPECT_TRUE(found_in(above(-overlap)).empty());
    }
  }
}

/// A needle, exactly through the middle of a plate that has there a node, or an edge, or a facet.
TEST(Intersections, AreFoundThroughNodesAndEdges) {
  const SurfaceMap flat = [](double u, double v) { return Vector(u, v, 0); };
  for (const int cells : {1, 2, 3, 4}) {
    for (const bool triangles : {false, true}) {
      const SurfaceMesh plate = grid(cells, cells, flat, triangles, false);
      for (const double tip : {-0.2, -1e-6}) {
        const SurfaceMesh needle = moved(block(3, {0, 0, tip}, {0.01, 0.01, 1}),
                                         Eigen::Matrix3d::Identity(), {0.5, 0.5, 0});
        EXPECT_FALSE(found_in({plate, needle}).empty()) << cells << " " << tip;
      }
      const SurfaceMesh short_needle =
          moved(block(3, {0, 0, 0}, {0.01, 0.01, 1}), Eigen::Matrix3d::Identity(), {0.5, 0.5, 0});
      EXPECT_TRUE(found_in({plate, short_needle}).empty()) << cells;
    }
    const SurfaceMesh floor = line(
        cells, [](double u) { return Eigen::Vector2d(u, 0.0); }, false);
    const auto post = [](double tip) {
      return line(
          1, [tip](double u) { return Eigen::Vector2d(0.5, tip + u); }, false);
    };
    EXPECT_FALSE(found_in({floor, post(-0.2)}).empty()) << cells;
    EXPECT_TRUE(found_in({floor, post(0.0)}).empty()) << cells;
  }
}

/// Where an edge meets a facet's plane is told by three equations.
TEST(Intersections, AreThoseOfEveryPair) {
  DrawNumbers draw(1);
  std::size_t count = 0;
  for (const int dim : {2, 3}) {
    for (int k = 0; k < 10; ++k) {
      std::vector<SurfaceMesh> meshes;
      for (int m = 0; m < 3; ++m)
        meshes.push_back(dim == 2
                             ? line(
                                   10,
                                   [&](double) {
                                     const Vector x = drawn_point(draw, 2, 1.0);
                                     return Eigen::Vector2d(x.x(), x.y());
                                   },
                                   false)
                             : grid(
                                   4, 3, [&](double, double) { return drawn_point(draw, 3, 1.0); },
                                   m > 0, false));
      const Skin skin = skin_of(meshes);
      const std::vector<Vector> x = points_of(meshes);
      std::vector<Intersection> expected;
      const std::size_t edges = dim == 2 ? skin.facets.size() : skin.edges.size();
      for (std::size_t e = 0; e < edges; ++e) {
        const std::int32_t p = dim == 2 ? skin.facets[e][0] : skin.edges[e][0],
                           q = dim == 2 ? skin.facets[e][1] : skin.edges[e][1];
        for (std::size_t n = 0; n < skin.facets.size(); ++n) {
          const auto& f = skin.facets[n];
          if (std::ranges::count(f, p) + std::ranges::count(f, q) > 0) continue;
          Eigen::Matrix3d m;
          m << x[p] - x[q], x[f[1]] - x[f[0]],
              dim == 2 ? Vector(Vector::UnitZ()) : Vector(x[f[2]] - x[f[0]]);
          const Vector s = m.inverse() * (x[p] - x[f[0]]);
          if (s[0] > 0 && s[0] < 1 && s[1] > 0 && s[1] < 1 &&
              (dim == 2 || (s[2] > 0 && s[1] + s[2] < 1)))
            expected.push_back({static_cast<std::int32_t>(e), static_cast<std::int32_t>(n)});
        }
      }
      // In drawn places nothing is as near as this to being exact.
      EXPECT_EQ(found_in(meshes, true, 1e-12), expected);
      count += expected.size();
    }
  }
  EXPECT_GT(count, 1000u);
}

}  // namespace
}  // namespace abut::surface_intersections_tests
