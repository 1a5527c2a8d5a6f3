// Goal: what facets leave of a round surface is allowed for at the start, and nothing else is.
// Oracles: regular polygons in closed form; circles of unlike facets that fit each other.

#include <cmath>

#include <gtest/gtest.h>

#include "surface/start_rows.hpp"
#include "tests/support/surfaces.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::surface_start_rows_tests {
namespace {

const double pi = std::acos(-1.0);

/// A quarter of a circle of radius 1 in n segments: the skin of a disk, or the bore around it.
SurfaceMesh quarter(int n, bool bore) {
  return line(
      n, [](double u) { return Eigen::Vector2d(std::cos(0.5 * pi * u), std::sin(0.5 * pi * u)); },
      bore);
}

TEST(StartRows, SagIsThatOfPolygons) {
  for (const int n : {4, 10, 40}) {
    // nodes lie beside the next one's tangent by 2 sin^2 of half the angle; the rise of an arc over
    // its chord, 1 - cos of that, is half of this half
    const double half = pi / (4.0 * n), sine = std::sin(half);
    EXPECT_NEAR(sag(quarter(n, false).pose()), sine * sine, roundoff(4.0, 1.0));
    EXPECT_GT(sag(quarter(n, false).pose()), 1.0 - std::cos(half));
  }
  // Segments that turn by more than 30 degrees are edges, but for the outer nodes of the rim.
  EXPECT_EQ(sag(quarter(2, false).pose()), 0.0);
  EXPECT_EQ(sag(line(
                    5, [](double u) { return Eigen::Vector2d(u, 2.0 * u); }, false)
                    .pose()),
            0.0);
  const auto flat = [](double u, double v) { return Eigen::Vector3d(u, v, u + v); };
  EXPECT_LT(sag(grid(4, 4, flat, false, false).pose()), roundoff(4.0, 1.0));
}

TEST(StartRows, NodesOfCirclesThatFitLieBehindEachOtherByNoMore) {
  for (const int n : {5, 16}) {
    for (const int k : {4, 11, 40}) {
      const SurfaceMesh skin = quarter(k, false), bore = quarter(n, true);
      const StartSurface one{skin.pose(), 0.5 * pi / k}, other{bore.pose(), 0.5 * pi / n};
      for (const SurfaceRows& rows : {node_rows(one, other), node_rows(other, one)})
        for (const double gap : rows.gaps) EXPECT_GE(gap, -roundness(one, other)) << k << " " << n;
    }
  }
}

}  // namespace
}  // namespace abut::surface_start_rows_tests
