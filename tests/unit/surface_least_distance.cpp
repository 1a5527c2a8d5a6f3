// Goal: the distance of two surfaces by trees is the least of all pairs of facets, never more than
// the distance of any two of their points, and exact between faces in parallel.
// Oracles: every pair tested, points drawn on the facets, plates and spheres.

#include "surface/least_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/surfaces.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::surface_least_distance_tests {
namespace {

double by_trees(const SurfaceMesh& a, const SurfaceMesh& b) {
  BoxTree ta, tb;
  build(ta, a.pose(), 0.0);
  build(tb, b.pose(), 0.0);
  return least_distance(a.pose(), ta, b.pose(), tb);
}

double box_gap(const Box& a, const Box& b) {
  double square = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double gap = std::max({0.0, a.low[i] - b.high[i], b.low[i] - a.high[i]});
    square += gap * gap;
  }
  return std::sqrt(square);
}

double by_every_pair(const SurfaceMesh& a, const SurfaceMesh& b) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < a.pose().facet_count(); ++i)
    for (int j = 0; j < b.pose().facet_count(); ++j)
      least = std::min(least,
                       std::max(box_gap(facet_box(a.pose(), i, 0.0), facet_box(b.pose(), j, 0.0)),
                                facets_apart(corners(a.pose(), i), corners(b.pose(), j))));
  return least;
}

SurfaceMesh sphere(int n, double radius) {
  return grid(
      n, n,
      [radius](double u, double v) {
        const double a = 2.0 * M_PI * u, b = M_PI * v;
        return Eigen::Vector3d(radius * std::sin(b) * std::cos(a),
                               radius * std::sin(b) * std::sin(a), radius * std::cos(b));
      },
      false, false);
}

SurfaceMesh circle(int n, double radius) {
  return line(
      n,
      [radius](double u) {
        return Eigen::Vector2d(radius * std::cos(2.0 * M_PI * u),
                               radius * std::sin(2.0 * M_PI * u));
      },
      false);
}

Eigen::Matrix3d turn(DrawNumbers& draw) {
  return Eigen::AngleAxisd(draw(-3.0, 3.0),
                           Eigen::Vector3d(draw(-1.0, 1.0), draw(-1.0, 1.0), 2.0).normalized())
      .toRotationMatrix();
}

TEST(LeastDistance, IsThatOfEveryPair) {
  DrawNumbers draw(3);
  for (int k = 0; k < 20; ++k) {
    const Eigen::Vector3d by(draw(0.5, 4.0), draw(-1.0, 1.0), draw(-1.0, 1.0));
    const SurfaceMesh a = sphere(9, 1.0), b = moved(sphere(7, 0.6), turn(draw), by);
    EXPECT_EQ(by_trees(a, b), by_every_pair(a, b));
    const SurfaceMesh c = circle(17, 1.0);
    const SurfaceMesh d = moved(circle(9, 0.6), Eigen::Matrix3d::Identity(), {by.x(), by.y(), 0.0});
    EXPECT_EQ(by_trees(c, d), by_every_pair(c, d));
  }
}

TEST(LeastDistance, IsNeverMoreThanThatOfTwoPoints) {
  DrawNumbers draw(4);
  for (int k = 0; k < 50; ++k) {
    const SurfaceMesh a = sphere(6, 1.0);
    const SurfaceMesh b = moved(sphere(5, 0.6), turn(draw), {draw(0.0, 3.0), draw(-1.0, 1.0), 0.0});
    double nodes = std::numeric_limits<double>::infinity();
    for (int i = 0; i < a.nodes(); ++i)
      for (int j = 0; j < b.nodes(); ++j)
        nodes = std::min(nodes, (a.pose().point(i) - b.pose().point(j)).norm());
    EXPECT_LE(by_trees(a, b), nodes);
  }
}

TEST(LeastDistance, OfTurnedPlatesInParallelIsTheirGap) {
  const auto plate = [](double z) {
    return [z](double u, double v) { return Eigen::Vector3d(u, v, z); };
  };
  DrawNumbers draw(6);
  for (const double gap : {1.0e-6, 0.01, 0.7}) {
    const Eigen::Matrix3d way = turn(draw);
    const SurfaceMesh a = moved(grid(5, 5, plate(0.0), false, false), way, {1.0, 2.0, 3.0});
    const SurfaceMesh b = moved(grid(4, 7, plate(gap), true, true), way, {1.0, 2.0, 3.0});
    EXPECT_NEAR(by_trees(a, b), gap, roundoff(64, 4.0));
  }
}

/// Polygons lie inside by h^2/(8 r): of facets of 2 pi/n and 2 pi/m.
TEST(LeastDistance, OfRoundBodiesIsTheirGapToTheRiseOfTheirFacets) {
  for (const double gap : {0.001, 0.1, 1.0}) {
    const SurfaceMesh a = circle(40, 1.0);
    const SurfaceMesh b =
        moved(circle(30, 0.5), Eigen::Matrix3d::Identity(), {1.5 + gap, 0.0, 0.0});
    const double found = by_trees(a, b), h = 2.0 * M_PI / 40, k = M_PI / 30;
    EXPECT_GE(found, gap * (1.0 - 1.0e-9));
    EXPECT_LE(found, gap + h * h / 8.0 + k * k / 4.0);
  }
}

TEST(LeastDistance, IsNothingWhereSurfacesCrossAndEndlessWithoutFacets) {
  EXPECT_EQ(by_trees(circle(12, 1.0), circle(11, 1.0)), 0.0);
  SurfaceMesh none;
  none.dim = 2;
  EXPECT_TRUE(std::isinf(by_trees(circle(12, 1.0), none)));
}

}  // namespace
}  // namespace abut::surface_least_distance_tests
