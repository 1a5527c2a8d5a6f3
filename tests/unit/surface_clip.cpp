// Goal: areas common to convex polygons are right to round-off, for polygons that touch, coincide
// or hold each other as well.
// Oracle: Boost.Geometry, and closed forms for the adverse cases.

// Without this Boost.Geometry rounds coordinates to a grid of some 1e-8 of their size.
#define BOOST_GEOMETRY_NO_ROBUSTNESS

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <cmath>
#include <vector>

#include "base/index.hpp"
#include "surface/clip.hpp"
#include "tests/support/surfaces.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::surface_clip_tests {
namespace {

using Eigen::Vector2d;
namespace bg = boost::geometry;
using BoostPolygon = bg::model::polygon<bg::model::d2::point_xy<double>, false>;

Polygon polygon(const std::vector<Vector2d>& corners) {
  Polygon p;
  for (const Vector2d& x : corners) p.add(x);
  return p;
}

Polygon box(double x0, double y0, double x1, double y1) {
  return polygon({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}});
}

/// Corners on an ellipse, anywhere, counterclockwise: convex.
Polygon random_polygon(int corners, DrawNumbers& draw) {
  std::vector<double> angles = draw.many(index(corners), 0.0, 6.283);
  std::sort(angles.begin(), angles.end());
  const Vector2d middle(draw(-0.5, 0.5), draw(-0.5, 0.5));
  const double a = draw(0.1, 1.0), b = draw(0.1, 1.0), turn = draw(0.0, 3.0);
  Polygon p;
  for (double t : angles)
    p.add(middle + Eigen::Rotation2Dd(turn) * Vector2d(a * std::cos(t), b * std::sin(t)));
  return p;
}

BoostPolygon boost_of(const Polygon& p) {
  BoostPolygon b;
  for (int i = 0; i <= p.count; ++i) {
    const Vector2d& x = p.x[i % p.count];
    bg::append(b.outer(), bg::model::d2::point_xy<double>(x.x(), x.y()));
  }
  return b;
}

TEST(Clip, AreasAreThoseOfBoostGeometry) {
  DrawNumbers draw(3);
  int common = 0;
  for (int k = 0; k < 20000; ++k) {
    const Polygon a = random_polygon(3 + k % 6, draw), b = random_polygon(3 + k % 5, draw);
    std::vector<BoostPolygon> parts;
    bg::intersection(boost_of(a), boost_of(b), parts);
    double area = 0.0;
    for (const BoostPolygon& part : parts) area += bg::area(part);
    const double ours = signed_area(clip(a, b));
    // Corners of size one at worst, moved by some ten roundings. Boost drops corners that are
    // nearer than that to another one and is no better.
    EXPECT_NEAR(ours, area, 1e-13) << k;
    EXPECT_NEAR(signed_area(clip(b, a)), ours, roundoff(40.0, 1.0)) << k;
    common += area > 0.0 ? 1 : 0;
  }
  EXPECT_GT(common, 5000);
}

TEST(Clip, IsInsideBoth) {
  DrawNumbers draw(4);
  for (int k = 0; k < 5000; ++k) {
    const Polygon a = random_polygon(4, draw), b = random_polygon(3, draw), c = clip(a, b);
    EXPECT_LE(c.count, 7);
    for (const Polygon* whole : {&a, &b}) {
      for (int e = 0; e < whole->count; ++e) {
        const Vector2d p = whole->x[e], t = (whole->x[(e + 1) % whole->count] - p).normalized();
        for (int i = 0; i < c.count; ++i)  // cuts along almost parallel edges lie near both
          EXPECT_GE(t.x() * (c.x[i] - p).y() - t.y() * (c.x[i] - p).x(), -1e-14);
      }
    }
  }
}

TEST(Clip, OfPolygonsThatTouchIsEmpty) {
  const Polygon unit = box(0, 0, 1, 1);
  for (const Polygon& other :
       {box(1, 0, 2, 1), box(0, -1, 1, 0), box(1, 0.25, 2, 0.75), box(1, 1, 2, 2),
        polygon({{1, 0.5}, {2, 0}, {2, 1}}), box(1 + 1e-16, 0, 2, 1), box(3, 3, 4, 4)}) {
    EXPECT_EQ(clip(unit, other).count, 0);
    EXPECT_EQ(clip(other, unit).count, 0);
  }
}

TEST(Clip, OfPolygonsThatHoldEachOtherIsTheSmallerOne) {
  const Polygon unit = box(0, 0, 1, 1);
  const double exact = 1e-15;  // sums of four products of size one
  EXPECT_NEAR(signed_area(clip(unit, unit)), 1.0, exact);
  for (const Polygon& inner : {box(0.25, 0.25, 0.5, 0.75), box(0, 0, 0.5, 1), box(0, 0.5, 1, 1),
                               polygon({{0, 0}, {1, 0}, {1, 1}}), box(0, 0, 1, 1e-3)}) {
    EXPECT_NEAR(signed_area(clip(unit, inner)), signed_area(inner), exact);
    EXPECT_NEAR(signed_area(clip(inner, unit)), signed_area(inner), exact);
  }
}

TEST(Clip, KeepsSlivers) {
  for (const double width : {1e-3, 1e-6, 1e-9, 1e-12}) {
    for (const double turn : {0.0, 0.3, 1.2}) {
      const Eigen::Rotation2Dd q(turn);
      Polygon a = box(0, 0, 1, 1), b = box(1 - width, 0, 2, 1);
      for (Polygon* p : {&a, &b})
        for (int i = 0; i < p->count; ++i) p->x[i] = q * p->x[i];
      // 1 - width is itself rounded by up to 1e-16, and so are turned corners
      EXPECT_NEAR(signed_area(clip(a, b)), width, 4e-15);
      EXPECT_NEAR(signed_area(clip(b, a)), width, 4e-15);
    }
  }
}

TEST(Clip, BearsRepeatedAndCollinearCorners) {
  const Polygon unit = box(0, 0, 1, 1);
  const Polygon crowded = polygon({{0.5, -1},
                                   {0.5, -1},
                                   {2, -1},
                                   {2, 0},
                                   {2, 0.5},
                                   {2, 2},
                                   {2, 2},
                                   {0.5, 2},
                                   {0.5, 1},
                                   {0.5, 1 - 1e-17},
                                   {0.5, 0}});
  EXPECT_NEAR(signed_area(clip(unit, crowded)), 0.5, roundoff(4.0, 1.0));
  EXPECT_NEAR(signed_area(clip(crowded, unit)), 0.5, roundoff(4.0, 1.0));
  const Polygon line = polygon({{0, 0.5}, {1, 0.5}, {0.5, 0.5}}), point = box(0.5, 0.5, 0.5, 0.5);
  for (const Polygon& flat : {line, point, Polygon{}}) {
    EXPECT_EQ(clip(unit, flat).count, 0);
    EXPECT_EQ(clip(flat, unit).count, 0);
  }
}

TEST(Clip, OfCrowdedPolygonsThatCrossManyTimesFits) {
  Polygon a, b;
  for (int i = 0; i < 12; ++i) {  // the most that two can have together
    const double t = 0.5235987755982989 * i;
    a.add({std::cos(t), std::sin(t)});
    b.add({std::cos(t + 0.2), std::sin(t + 0.2)});
  }
  const Polygon c = clip(a, b);
  EXPECT_EQ(c.count, 24);
  EXPECT_LT(signed_area(c), signed_area(a));
  EXPECT_GT(signed_area(c), 0.97 * signed_area(a));
}

TEST(Clip, OfIntervalsIsWhatBothHold) {
  EXPECT_EQ(clip(Interval{0, 2}, Interval{1, 3}).length(), 1.0);
  EXPECT_EQ(clip(Interval{0, 4}, Interval{1, 3}).length(), 2.0);
  EXPECT_TRUE(clip(Interval{0, 1}, Interval{1, 3}).empty());
  EXPECT_TRUE(clip(Interval{0, 1}, Interval{2, 3}).empty());
  EXPECT_EQ(clip(Interval{0, 1}, Interval{2, 3}).length(), 0.0);
}

}  // namespace
}  // namespace abut::surface_clip_tests
