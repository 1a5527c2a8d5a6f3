// Goal: the closest point of a facet and of a surface is the closest one, with its feature named.
// Oracle: closed forms on segments and triangles, dense sampling on warped quadrilaterals, every
// facet on surfaces.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "surface/closest_point.hpp"
#include "surface/plane_facet.hpp"
#include "tests/support/surfaces.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::surface_closest_point_tests {
namespace {

using Eigen::Vector3d;
constexpr double exact = 1e-14;  // some tens of roundings of numbers of size one

Vector3d on(const Corners& facet, const Shape4& shape) {
  Vector3d x = Vector3d::Zero();
  for (int i = 0; i < facet.count; ++i) x += shape[i] * facet.x[i];
  return x;
}

TEST(ClosestPoint, OnASegmentIsInsideOrAnEnd) {
  const Corners segment{2, {Vector3d(0, 0, 0), Vector3d(2, 0, 0)}};
  const ClosestPoint inside = closest_point(segment, {0.5, 1, 0});
  EXPECT_EQ(inside.feature, FacetFeature::inside);
  EXPECT_EQ(inside.index, -1);
  EXPECT_NEAR(inside.distance, 1.0, exact);
  EXPECT_NEAR(inside.local[0], 0.25, exact);
  const ClosestPoint end = closest_point(segment, {3, 0, 0});
  EXPECT_EQ(end.feature, FacetFeature::vertex);
  EXPECT_EQ(end.index, 1);
  EXPECT_EQ(end.distance, 1.0);
  EXPECT_EQ(closest_point(segment, {-1, 2, 0}).index, 0);
}

TEST(ClosestPoint, OnATriangleIsInEachOfSevenRegions) {
  const Corners t{3, {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)}};
  struct {
    Vector3d x;
    FacetFeature feature;
    int index;
    double distance;
  } cases[] = {{{0.2, 0.3, 2}, FacetFeature::inside, -1, 2.0},
               {{0.5, -1, 0}, FacetFeature::edge, 0, 1.0},
               {{1, 1, 0}, FacetFeature::edge, 1, std::sqrt(0.5)},
               {{-1, 0.5, 0}, FacetFeature::edge, 2, 1.0},
               {{-1, -1, 0}, FacetFeature::vertex, 0, std::sqrt(2.0)},
               {{3, -1, 0}, FacetFeature::vertex, 1, std::sqrt(5.0)},
               {{-1, 3, 0}, FacetFeature::vertex, 2, std::sqrt(5.0)}};
  for (const auto& c : cases) {
    const ClosestPoint found = closest_point(t, c.x);
    EXPECT_EQ(found.feature, c.feature);
    EXPECT_EQ(found.index, c.index);
    EXPECT_NEAR(found.distance, c.distance, exact);
    EXPECT_LE((on(t, found.shape) - found.point).norm(), exact);
  }
}

/// The least distance among points of a lattice over the quadrilateral.
double sampled(const Corners& quad, const Vector3d& x, int lattice) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= lattice; ++i) {
    for (int j = 0; j <= lattice; ++j) {
      const double a = double(i) / lattice, b = double(j) / lattice;
      const Shape4 shape((1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b);
      least = std::min(least, (on(quad, shape) - x).norm());
    }
  }
  return least;
}

TEST(ClosestPoint, OnWarpedQuadrilateralsIsNoFurtherThanAnySample) {
  DrawNumbers draw(8);
  int inside = 0;
  for (int k = 0; k < 3000; ++k) {
    Corners quad{4, {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(1, 1, 0), Vector3d(0, 1, 0)}};
    for (int i = 0; i < 4; ++i)
      quad.x[i] += Vector3d(draw(-0.3, 0.3), draw(-0.3, 0.3), draw(-0.3, 0.3));
    const Vector3d x(draw(-0.5, 1.5), draw(-0.5, 1.5), draw(-1, 1));
    const ClosestPoint found = closest_point(quad, x);
    EXPECT_LE((on(quad, found.shape) - found.point).norm(), exact);
    EXPECT_NEAR(found.shape.sum(), 1.0, exact);
    EXPECT_GE(found.shape.minCoeff(), 0.0);
    EXPECT_NEAR((x - found.point).norm(), found.distance, exact);
    EXPECT_LE(found.distance, sampled(quad, x, 40) + exact) << k;
    if (found.feature != FacetFeature::inside) continue;
    ++inside;  // and the way is perpendicular to both tangents: Newton stops at steps of 1e-16,
    // and tangents are up to 1.6 + 1 long
    const double a = found.local[0], b = found.local[1];
    const Vector3d da = (1 - b) * (quad.x[1] - quad.x[0]) + (1 + b) * (quad.x[2] - quad.x[3]);
    const Vector3d db = (1 - a) * (quad.x[3] - quad.x[0]) + (1 + a) * (quad.x[2] - quad.x[1]);
    EXPECT_NEAR((x - found.point).dot(da), 0.0, roundoff(20.0, 2.6));
    EXPECT_NEAR((x - found.point).dot(db), 0.0, roundoff(20.0, 2.6));
  }
  EXPECT_GT(inside, 500);
}

TEST(ClosestPoint, OfAPointOnTheFacetIsThatPoint) {
  DrawNumbers draw(9);
  for (int k = 0; k < 1000; ++k) {
    Corners quad{4, {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(1, 1, 0), Vector3d(0, 1, 0)}};
    for (int i = 0; i < 4; ++i)
      quad.x[i] += Vector3d(draw(-0.2, 0.2), draw(-0.2, 0.2), draw(-0.2, 0.2));
    const double a = draw(0, 1), b = draw(0, 1);
    const Vector3d x = on(quad, {(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b});
    const ClosestPoint found = closest_point(quad, x);
    EXPECT_LE(found.distance, exact);
    EXPECT_NEAR(found.local[0], 2 * a - 1, 1e-13);  // distances over half an edge's length
    EXPECT_NEAR(found.local[1], 2 * b - 1, 1e-13);
  }
}

TEST(ClosestPoint, OfASurfaceIsTheBestOfAllFacets) {
  DrawNumbers draw(10);
  const auto wavy = [](double u, double v) {
    return Vector3d(u, v, 0.2 * std::sin(5 * u) * std::cos(4 * v));
  };
  for (const bool triangles : {false, true}) {
    const SurfaceMesh mesh = grid(9, 7, wavy, triangles, false);
    BoxTree tree;
    build(tree, mesh.pose(), 0.1);
    for (int k = 0; k < 300; ++k) {
      const Vector3d x(draw(-0.5, 1.5), draw(-0.5, 1.5), draw(-1, 1));
      double least = std::numeric_limits<double>::infinity(), facing = least;
      for (int f = 0; f < mesh.pose().facet_count(); ++f) {
        const Corners c = corners(mesh.pose(), f);
        const double distance = closest_point(c, x).distance;
        least = std::min(least, distance);
        if (mean_normal(c).x() <= -0.5) facing = std::min(facing, distance);
      }
      const std::optional<SurfacePoint> found = closest_point(mesh.pose(), tree, x);
      ASSERT_TRUE(found);
      EXPECT_EQ(found->at.distance, least);
      EXPECT_FALSE(closest_point(mesh.pose(), tree, x, {.reach = 0.999 * least}));
      const std::optional<SurfacePoint> other =
          closest_point(mesh.pose(), tree, x, {.against = Vector3d::UnitX(), .facing = 0.5});
      ASSERT_TRUE(other);
      EXPECT_EQ(other->at.distance, facing);
    }
  }
}

TEST(PlaneFacet, ShapeFunctionsAreFoundInDistortedQuadrilaterals) {
  DrawNumbers draw(12);
  for (int k = 0; k < 20000; ++k) {
    Corners quad{4, {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(1, 1, 0), Vector3d(0, 1, 0)}};
    const double distortion = k % 3 == 0 ? 1e-9 : 0.24;  // almost straight, and almost folded
    for (int i = 0; i < 4; ++i)
      quad.x[i] += Vector3d(draw(-distortion, distortion), draw(-distortion, distortion), 0.0);
    AuxiliaryPlane plane = auxiliary_plane(quad);
    if (k % 2 == 1) {  // seen from behind
      plane.normal = -plane.normal;
      plane.second = -plane.second;
    }
    const PlaneFacet seen = seen_in(plane, quad);
    const double a = draw(0, 1), b = draw(0, 1);
    const Shape4 shape((1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b);
    const Eigen::Vector2d z = plane.project(on(quad, shape));
    // the Jacobian is 1/20 of a square's at the least: some tens of roundings over that
    EXPECT_LE((seen.shape(z) - shape).cwiseAbs().maxCoeff(), 2e-13) << k;
    EXPECT_NEAR(signed_area(seen.polygon()), area(quad), exact);
  }
}

}  // namespace
}  // namespace abut::surface_closest_point_tests
