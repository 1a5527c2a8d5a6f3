// Goal: what facets leave of a round surface is allowed for at the start, and nothing else is.
// Oracles: regular polygons in closed form; circles of unlike facets that fit each other.

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

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

/// An outline in the plane, anticlockwise.
struct Outline {
  std::vector<double> points;
  std::vector<std::int32_t> facets{}, offsets{0};

  explicit Outline(std::vector<double> around) : points(std::move(around)) {
    const auto count = static_cast<std::int32_t>(points.size() / 2);
    for (std::int32_t a = 0; a < count; ++a) {
      facets.insert(facets.end(), {a, (a + 1) % count});
      offsets.push_back(2 * a + 2);
    }
  }
  PosedSurface pose() const { return {2, points, facets, offsets}; }
};

TEST(StartRows, AreOfWhatIsRoundBeforeFacetsWhoseOwnEdgesAreFarAway) {
  const Outline block({-6, -4, 6, -4, 6, 0, 2, 0, -2, 0, -6, 0});
  const auto ball = [](double x) {
    std::vector<double> around;
    for (int i = 0; i < 24; ++i) {
      const double angle = (i - 6) * pi / 12.0;
      around.insert(around.end(), {x + 8.0 * std::cos(angle), 8.05 + 8.0 * std::sin(angle)});
    }
    return Outline(around);
  };
  const Outline over_middle = ball(0.0), over_corner = ball(6.0);
  const StartSurface finder{block.pose(), 4.0};
  EXPECT_TRUE(rows_of_other(finder, {over_middle.pose(), 2.1}));
  EXPECT_FALSE(rows_of_other({over_middle.pose(), 2.1}, finder));
  EXPECT_FALSE(rows_of_other(finder, {over_corner.pose(), 2.1}));
}

}  // namespace
}  // namespace abut::surface_start_rows_tests
