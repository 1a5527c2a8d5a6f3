// Goal: the first time at which features on straight ways come within a distance is never late, and
// early by no more than its tolerance says.
// Oracles: closed forms of translations and of turning edges; places in between, densely sampled.

#include "surface/feature_path.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tests/support/feature_cases.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::surface_feature_path_tests {
namespace {

using Vector = Eigen::Vector3d;

FeaturePoints shifted(FeaturePoints x, std::size_t begin, std::size_t end, const Vector& by) {
  for (std::size_t i = begin; i < end; ++i) x[i] += by;
  return x;
}

/// A node, or edge, above the inside of a facet, or edge.
FeaturePoints above(FeatureCase c, double height) {
  if (c.dim == 2) return {Vector(0.3, height, 0), Vector(0, 0, 0), Vector(1, 0, 0), Vector::Zero()};
  if (c.kind == FeatureKind::node_facet)
    return {Vector(0.3, 0.3, height), Vector(0, 0, 0), Vector(1, 0, 0), Vector(0, 1, 0)};
  return {Vector(0.3, 0.2, height), Vector(0.5, 0.7, height), Vector(0, 0.5, 0), Vector(1, 0.5, 0)};
}

/// What comes down through a facet or an edge, how fast and oblique ever, is told when it is there.
TEST(FeaturePath, OfASpikeTowardsAPlane) {
  constexpr double distance = 0.01, tolerance = 1e-4;
  for (const FeatureCase c : feature_cases) {
    for (const double speed : {1.001, 2.0, 30.0, 1e5}) {
      for (const Vector& common : {Vector(0, 0, 0), Vector(7, -40, c.dim == 3 ? 3 : 0)}) {
        const FeaturePoints x0 = above(c, 1.0);
        const std::size_t first = c.kind == FeatureKind::node_facet ? 1 : 2;
        const Vector down = c.dim == 2 ? Vector(0, -speed, 0) : Vector(0, 0, -speed);
        const FeaturePoints x1 = shifted(shifted(x0, 0, first, down), 0, 4, common);
        const double t = first_time_within(c.kind, c.dim, x0, x1, distance, tolerance);
        EXPECT_LE(t, (1.0 - distance) / speed);
        EXPECT_GE(t, (1.0 - distance - tolerance) / speed);
      }
    }
  }
}

/// A node above the middle of a facet, or an edge above another, by a ten-millionth of the sizes
/// and less: the difference of their places is a few digits of these, so that its direction is off,
/// over the facet's length by more than the distance. What parts from there is on its way.
TEST(FeaturePath, NeverOfFeaturesThatPartFromHardlyAnyDistance) {
  for (const FeatureCase c : feature_cases) {
    for (const double apart : {1.0e-8, 1.0e-9, 1.0e-10}) {
      for (const Vector& place : {Vector(0.1, 0.7, 0), Vector(1.0 / 3.0, 0.05, 0)}) {
        const FeaturePoints x0 = shifted(above(c, apart), 0, 4, place);
        const std::size_t first = c.kind == FeatureKind::node_facet ? 1 : 2;
        const Vector up = c.dim == 2 ? Vector(0, apart, 0) : Vector(0, 0, apart);
        const FeaturePoints x1 = shifted(x0, 0, first, up);
        const double distance = feature_distance(c.kind, c.dim, x0).distance;
        EXPECT_EQ(first_time_within(c.kind, c.dim, x0, x1, 0.9 * distance, 0.018 * distance), 1.0)
            << apart;
        // Towards it, by half of the distance: told before there is a tenth less of it.
        const FeaturePoints near = shifted(x0, 0, first, -0.5 * up);
        EXPECT_LE(first_time_within(c.kind, c.dim, x0, near, 0.9 * distance, 0.018 * distance),
                  0.2 * (1.0 + 1.0e-4));  // of roundings of places, 1e-16 of 1e-10
      }
    }
  }
}

TEST(FeaturePath, NeverOfFeaturesThatPartOrMoveTogether) {
  DrawNumbers draw(1);
  for (const FeatureCase c : feature_cases) {
    for (int k = 0; k < 300; ++k) {
      const FeaturePoints x0 = drawn_points(draw, c.dim, 1.0);
      const FeatureDistance d = feature_distance(c.kind, c.dim, x0);
      const std::size_t first = c.kind == FeatureKind::node_facet ? 1 : 2;
      const Vector away = draw(0.0, 10.0) * d.difference(x0) / d.distance;
      // Numbers that all differences with x0 keep exactly, so that nothing is left of the motion.
      const Vector common(512.0, -1024.0, c.dim == 3 ? 256.0 : 0.0);
      const FeaturePoints apart = shifted(shifted(x0, 0, first, away), 0, 4, common);
      const double tolerance = 0.01 * d.distance;
      EXPECT_EQ(first_time_within(c.kind, c.dim, x0, apart, 0.9 * d.distance, tolerance), 1.0);
      EXPECT_EQ(first_time_within(c.kind, c.dim, x0, shifted(x0, 0, 4, common), 0.9 * d.distance,
                                  tolerance),
                1.0);
      EXPECT_EQ(first_time_within(c.kind, c.dim, x0, x0, 0.9 * d.distance, tolerance), 1.0);
    }
  }
}

TEST(FeaturePath, BeginsAtOnceOfFeaturesThatAreWithin) {
  DrawNumbers draw(2);
  for (const FeatureCase c : feature_cases) {
    for (int k = 0; k < 300; ++k) {
      const FeaturePoints x0 = drawn_points(draw, c.dim, 1.0), x1 = drawn_points(draw, c.dim, 1.0);
      const double d = feature_distance(c.kind, c.dim, x0).distance;
      EXPECT_EQ(first_time_within(c.kind, c.dim, x0, x1, d, 0.01 * d), 0.0);
      EXPECT_EQ(first_time_within(c.kind, c.dim, x0, x1, 1.5 * d, 0.01 * d), 0.0);
      EXPECT_GT(first_time_within(c.kind, c.dim, x0, x1, 0.9 * d, 0.01 * d), 0.0);
    }
    FeaturePoints touching = above(c, 0.0);
    EXPECT_EQ(first_time_within(c.kind, c.dim, touching, above(c, 1.0), 0.0, 0.0), 0.0);
  }
}

/// An edge whose ends come down at unlike speeds turns above another one: its height above the
/// crossing is 1 - t, its slope t m, its distance (1 - t) / sqrt(1 + m^2 t^2).
TEST(FeaturePath, OfAnEdgeThatTurnsPastAnEdge) {
  for (const double m : {0.0, 0.3, 2.0, 10.0}) {
    for (const double distance : {0.3, 0.01, 1e-5}) {
      const FeaturePoints x0{Vector(0, -1, 1), Vector(0, 1, 1), Vector(-1, 0, 0), Vector(1, 0, 0)};
      const FeaturePoints x1{Vector(0, -1, -m), Vector(0, 1, m), x0[2], x0[3]};
      // (1 - t)^2 = d^2 (1 + m^2 t^2)
      const auto time = [m](double d) {
        const double a = 1.0 - d * d * m * m, c = 1.0 - d * d;
        return c / (1.0 + std::sqrt(1.0 - a * c));
      };
      const double tolerance = 0.02 * distance;
      const double t = first_time_within(FeatureKind::edge_edge, 3, x0, x1, distance, tolerance);
      EXPECT_LE(t, time(distance)) << m << " " << distance;
      EXPECT_GE(t, time(distance + tolerance) - roundoff(10.0, 1.0)) << m << " " << distance;
    }
  }
}

/// A segment whose far end comes down past a node: the node's height above the line through it.
TEST(FeaturePath, OfASegmentThatSwingsOntoANode) {
  const FeaturePoints x0{Vector(0.5, 0, 0), Vector(0, 1, 0), Vector(1, 1, 0), Vector::Zero()};
  const FeaturePoints x1{x0[0], x0[1], Vector(1, -2, 0), Vector::Zero()};
  // The line at .5: 1 - 1.5 t, its slope -3 t; the distance (1 - 1.5 t) / sqrt(1 + 9 t^2).
  for (const double distance : {0.2, 1e-2, 1e-4}) {
    const auto apart = [](double t) { return (1.0 - 1.5 * t) / std::hypot(1.0, 3.0 * t); };
    const double tolerance = 0.02 * distance;
    const double t = first_time_within(FeatureKind::node_facet, 2, x0, x1, distance, tolerance);
    EXPECT_GE(apart(t), distance);
    EXPECT_LE(apart(t), distance + tolerance + roundoff(10.0, 1.0));
  }
}

/// Ways of all sizes, some hardly moving and some far past each other, in a corner far off, too.
TEST(FeaturePath, IsNeverLateNorEarly) {
  DrawNumbers draw(3);
  constexpr int samples = 500;
  int met = 0, passed = 0;
  for (int k = 0; k < 10000; ++k) {
    const FeatureCase c = feature_cases[k % 3];
    const FeaturePoints x0 = drawn_points(draw, c.dim, 1.0);
    FeaturePoints x1 = drawn_points(draw, c.dim, std::pow(10.0, draw(-2.0, 1.0)));
    for (std::size_t i = 0; i < 4; ++i) x1[i] += x0[i];
    const double begin = feature_distance(c.kind, c.dim, x0).distance;
    const double distance = begin * draw(0.01, 0.9), tolerance = 0.02 * distance;
    const double t = first_time_within(c.kind, c.dim, x0, x1, distance, tolerance);
    const auto apart = [&](double time) {
      return feature_distance(c.kind, c.dim, on_the_way(x0, x1, time)).distance;
    };
    double least = begin;
    for (int i = 0; i <= samples; ++i) least = std::min(least, apart(t * i / samples));
    // Places of size 10 are rounded here.
    const double rounding = roundoff(10.0, 10.0);
    EXPECT_GT(least, distance - rounding) << k;
    if (t < 1.0) {
      EXPECT_LE(apart(t), distance + tolerance + rounding) << k;
      ++met;
    } else {
      ++passed;
    }
  }
  EXPECT_GT(met, 1000);
  EXPECT_GT(passed, 1000);
}

/// What the passive way builds on: as long as no step is longer than such a time, nothing ever
/// touches, whatever the motion of the next step.
TEST(FeaturePath, StepsThatKeepToItNeverTouch) {
  DrawNumbers draw(4);
  for (int k = 0; k < 300; ++k) {
    const FeatureCase c = feature_cases[k % 3];
    FeaturePoints x = drawn_points(draw, c.dim, 1.0);
    for (int step = 0; step < 20; ++step) {
      const double d = feature_distance(c.kind, c.dim, x).distance;
      ASSERT_GT(d, 0.0);
      FeaturePoints to = drawn_points(draw, c.dim, 1.0);
      const double t = first_time_within(c.kind, c.dim, x, to, 0.3 * d, 0.006 * d);
      for (int i = 0; i <= 20; ++i)
        ASSERT_GT(feature_distance(c.kind, c.dim, on_the_way(x, to, 0.9 * t * i / 20)).distance,
                  0.29 * d);
      x = on_the_way(x, to, 0.9 * t);
    }
  }
}

}  // namespace
}  // namespace abut::surface_feature_path_tests
