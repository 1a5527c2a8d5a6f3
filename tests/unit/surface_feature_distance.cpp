// Goal: the distance of two features is the least there is, wherever on them the closest points
// are, however parallel or small they are.
// Oracles: pairs made from their closest points and a direction that these allow; closed forms of
// nearly parallel edges and slivers; the least that a search finds.

#include "surface/feature_distance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/feature_cases.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::surface_feature_distance_tests {
namespace {

using Vector = Eigen::Vector3d;

// Some thirty operations with numbers of size 1 to 3, divided by areas of .1 at least.
const double few = roundoff(1000.0, 1.0);

void expect_sound(FeatureKind kind, const FeaturePoints& x, const FeatureDistance& d) {
  EXPECT_NEAR(d.difference(x).norm(), d.distance, few);
  const int first = kind == FeatureKind::node_facet ? 1 : 2;
  double one = 0.0, other = 0.0;
  for (int i = 0; i < 4; ++i) {
    (i < first ? one : other) += d.weights[i];
    EXPECT_GE(i < first ? d.weights[i] : -d.weights[i], 0.0);
  }
  EXPECT_NEAR(one, 1.0, few);
  EXPECT_NEAR(other, -1.0, few);
}

void expect_weights(const FeatureDistance& d, const std::array<double, 4>& weights) {
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(d.weights[i], weights[i], few) << i;
}

/// A facet point with shares b of its corners; the difference is any that its feature allows.
TEST(FeatureDistance, OfANodeInEveryRegionOfATriangle) {
  DrawNumbers draw(1);
  const Eigen::Matrix3d turn = some_rotation();
  for (int region = 1; region < 8; ++region) {  // a bit for each corner with a share
    for (int k = 0; k < 200; ++k) {
      std::array<Vector, 3> t{Vector(0, 0, 0), Vector(draw(1, 2), 0, 0),
                              Vector(draw(-0.5, 1.5), draw(0.5, 1.5), 0)};
      std::array<double, 3> share{};
      for (int i = 0; i < 3; ++i) share[i] = region >> i & 1 ? draw(0.1, 1.0) : 0.0;
      const double sum = share[0] + share[1] + share[2];
      Vector on = Vector::Zero(), away = draw(-1.0, 1.0) * Vector::UnitZ();
      for (int i = 0; i < 3; ++i) {
        share[i] /= sum;
        on += share[i] * t[i];
      }
      for (int i = 0; i < 3; ++i) {  // across the edge against corner i, when the point is on it
        if (share[i] != 0.0) continue;
        const Vector edge = t[(i + 2) % 3] - t[(i + 1) % 3];
        away += draw(0.1, 1.0) * Vector(edge.y(), -edge.x(), 0.0).normalized();
      }
      const Vector by(0.3, -0.2, 0.7);
      FeaturePoints x{turn * (on + away) + by};
      for (int i = 0; i < 3; ++i) x[i + 1] = turn * t[i] + by;
      const FeatureDistance d = feature_distance(FeatureKind::node_facet, 3, x);
      EXPECT_NEAR(d.distance, away.norm(), few);
      expect_weights(d, {1.0, -share[0], -share[1], -share[2]});
      expect_sound(FeatureKind::node_facet, x, d);
    }
  }
}

TEST(FeatureDistance, OfANodeInEveryRegionOfASegment) {
  DrawNumbers draw(2);
  for (int region = 0; region < 3; ++region) {
    for (int k = 0; k < 100; ++k) {
      const double angle = draw(-3.0, 3.0), s = region == 0 ? 0.0 : region == 1 ? 1.0 : draw(0, 1);
      const Vector u(std::cos(angle), std::sin(angle), 0.0), n(-u.y(), u.x(), 0.0);
      const double along = region == 0 ? -draw(0, 1) : region == 1 ? draw(0, 1) : 0.0;
      const double across = draw(-1.0, 1.0), length = draw(0.5, 2.0);
      const Vector a(0.2, 0.1, 0.0), nowhere = Vector::Constant(NAN);  // not looked at
      const FeaturePoints x{a + (s * length + along) * u + across * n, a, a + length * u, nowhere};
      const FeatureDistance d = feature_distance(FeatureKind::node_facet, 2, x);
      EXPECT_NEAR(d.distance, std::hypot(along, across), few);
      expect_weights(d, {1.0, s - 1.0, -s, 0.0});
      expect_sound(FeatureKind::node_facet, x, d);
    }
  }
}

/// Closest points at both beginnings, insides and ends: of the difference, from the second to the
/// first, the part along an edge vanishes inside, and points away from it at its ends.
TEST(FeatureDistance, OfTwoEdgesInEveryRegion) {
  DrawNumbers draw(3);
  for (int region = 0; region < 9; ++region) {
    const int first = region % 3, second = region / 3;  // 0: begin, 1: inside, 2: end
    for (int k = 0; k < 200; ++k) {
      const Vector u = draw(0.5, 2.0) * Vector::UnitX();
      const double angle = draw(0.2, 2.9), length = draw(0.5, 2.0);
      const Vector v = length * Vector(std::cos(angle), std::sin(angle), 0.0);
      const double s = first == 1 ? draw(0.05, 0.95) : 0.5 * first;
      const double t = second == 1 ? draw(0.05, 0.95) : 0.5 * second;
      const double by_u = (1 - first) * draw(0.0, 1.0), by_v = (second - 1) * draw(0.0, 1.0);
      Eigen::Matrix2d edges;
      edges << u.x(), u.y(), v.x(), v.y();
      const Eigen::Vector2d flat = edges.inverse() * Eigen::Vector2d(by_u, by_v);
      const Vector away(flat.x(), flat.y(), draw(-1.0, 1.0));
      const Vector a(0.1, 0.2, -0.3), c = a + s * u - away - t * v;
      const Eigen::Matrix3d turn = some_rotation();
      const FeaturePoints x{turn * a, turn * (a + u), turn * c, turn * (c + v)};
      const FeatureDistance d = feature_distance(FeatureKind::edge_edge, 3, x);
      EXPECT_NEAR(d.distance, away.norm(), 10.0 * few);  // the inverse above
      expect_sound(FeatureKind::edge_edge, x, d);
    }
  }
}

/// Edges that cross, seen from above, in their insides at a small angle and height.
TEST(FeatureDistance, OfNearlyParallelEdgesThatCross) {
  const Eigen::Matrix3d turn = some_rotation();
  for (const double height : {1.0, 1e-3, 1e-6, 1e-9}) {
    for (double angle = 0.5; angle > 1e-18; angle *= 0.1) {
      const Vector u = Vector::UnitX(), v(std::cos(angle), std::sin(angle), 0.0);
      const Vector up = height * Vector::UnitZ();
      const FeaturePoints x{turn * -0.6 * u, turn * 0.4 * u, turn * (up - 0.3 * v),
                            turn * (up + 0.7 * v)};
      const FeatureDistance d = feature_distance(FeatureKind::edge_edge, 3, x);
      // Places are rounded; the shares' rounding, by the angle, moves points by the angle only.
      EXPECT_NEAR(d.distance, height, roundoff(10.0, 1.0)) << height << " " << angle;
      expect_sound(FeatureKind::edge_edge, x, d);
    }
  }
}

/// A node above the inside of a triangle whose corners are hardly off a line.
TEST(FeatureDistance, OfANodeAboveASliver) {
  const Eigen::Matrix3d turn = some_rotation();
  for (const double height : {1.0, 1e-3, 1e-6, 1e-9}) {
    for (double width = 0.5; width > 1e-14; width *= 0.1) {
      for (int first = 0; first < 3; ++first) {
        std::array<Vector, 3> t{Vector(0, 0, 0), Vector(1, 0, 0), Vector(0.4, width, 0)};
        std::rotate(t.begin(), t.begin() + first, t.end());
        const Vector on = 0.2 * t[0] + 0.3 * t[1] + 0.5 * t[2];
        const FeaturePoints x{turn * (on + height * Vector::UnitZ()), turn * t[0], turn * t[1],
                              turn * t[2]};
        const FeatureDistance d = feature_distance(FeatureKind::node_facet, 3, x);
        EXPECT_NEAR(d.distance, height, roundoff(10.0, 1.0)) << height << " " << width;
        expect_sound(FeatureKind::node_facet, x, d);
      }
    }
  }
}

TEST(FeatureDistance, OfParallelEdges) {
  for (const double way : {1.0, -1.0}) {
    for (const double begin : {-3.0, -1.5, -0.4, 0.3, 0.9, 1.2, 4.0}) {  // one ends at 0 and 1
      const FeaturePoints x{Vector(0, 0, 0), Vector(1, 0, 0), Vector(begin, 0.3, 0.4),
                            Vector(begin + way, 0.3, 0.4)};
      const double low = std::min(begin, begin + way), high = std::max(begin, begin + way);
      const FeatureDistance d = feature_distance(FeatureKind::edge_edge, 3, x);
      EXPECT_NEAR(d.distance, std::hypot(0.5, std::max({0.0, low - 1.0, -high})), few);
      expect_sound(FeatureKind::edge_edge, x, d);
    }
  }
}

/// Of features that have shrunk to an edge or a point it is the distance of what is left.
TEST(FeatureDistance, OfFeaturesWithoutExtent) {
  DrawNumbers draw(4);
  for (int k = 0; k < 100; ++k) {
    const Vector p = drawn_point(draw, 3, 1.0), a = drawn_point(draw, 3, 1.0),
                 b = drawn_point(draw, 3, 1.0), between = a + draw(0.0, 1.0) * (b - a);
    const double edge = feature_distance(FeatureKind::edge_edge, 3, {p, p, a, b}).distance;
    EXPECT_EQ(feature_distance(FeatureKind::node_facet, 2, {p, a, b, b}).distance, edge);
    EXPECT_NEAR(feature_distance(FeatureKind::edge_edge, 3, {b, a, p, p}).distance, edge, few);
    for (const FeaturePoints& x :
         {FeaturePoints{p, a, b, b}, {p, b, b, a}, {p, a, b, a}, {p, a, between, b}}) {
      const FeatureDistance d = feature_distance(FeatureKind::node_facet, 3, x);
      EXPECT_NEAR(d.distance, edge, few);
      expect_sound(FeatureKind::node_facet, x, d);
    }
    EXPECT_NEAR(feature_distance(FeatureKind::node_facet, 3, {p, a, a, a}).distance, (p - a).norm(),
                few);
    EXPECT_NEAR(feature_distance(FeatureKind::edge_edge, 3, {p, p, a, a}).distance, (p - a).norm(),
                few);
  }
}

/// The least of a convex function between two places, by halving in golden ratio.
template <class F>
double least_of(const F& f, double low, double high) {
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  double a = high - ratio * (high - low), b = low + ratio * (high - low), fa = f(a), fb = f(b);
  double least = std::min({f(low), f(high), fa, fb});
  for (int k = 0; k < 45; ++k) {  // until 4e-10 of the begin is left
    if (fa < fb) {
      high = b;
      b = a;
      fb = fa;
      fa = f(a = high - ratio * (high - low));
    } else {
      low = a;
      a = b;
      fa = fb;
      fb = f(b = low + ratio * (high - low));
    }
    least = std::min({least, fa, fb});
  }
  return least;
}

/// Over one share, the least over the other one: convex as the distance is in both.
double by_search(FeatureCase c, const FeaturePoints& x) {
  const Vector difference = x[0] - (c.kind == FeatureKind::edge_edge ? x[2] : x[1]);
  if (c.dim == 2)
    return least_of([&](double s) { return (difference - s * (x[2] - x[1])).norm(); }, 0.0, 1.0);
  const Vector u = c.kind == FeatureKind::edge_edge ? Vector(x[0] - x[1]) : Vector(x[2] - x[1]);
  const Vector v = c.kind == FeatureKind::edge_edge ? Vector(x[3] - x[2]) : Vector(x[3] - x[1]);
  return least_of(
      [&](double s) {
        const double most = c.kind == FeatureKind::edge_edge ? 1.0 : 1.0 - s;
        return least_of([&](double t) { return (difference - s * u - t * v).norm(); }, 0.0, most);
      },
      0.0, 1.0);
}

TEST(FeatureDistance, IsTheLeastOfASearch) {
  DrawNumbers draw(5);
  for (const FeatureCase c : feature_cases) {
    for (int k = 0; k < 400; ++k) {
      const FeaturePoints x = drawn_points(draw, c.dim, 1.0);
      const double least = by_search(c, x);
      const FeatureDistance d = feature_distance(c.kind, c.dim, x);
      EXPECT_LE(d.distance, least + few);
      // The search ends within 1e-9 of the closest points, on features of size 4 at most.
      EXPECT_GE(d.distance, least - 1e-8);
      expect_sound(c.kind, x, d);
    }
  }
}

}  // namespace
}  // namespace abut::surface_feature_distance_tests
