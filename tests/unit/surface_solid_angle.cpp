// Goal: it is told how much of the view a surface takes, and from which side it is seen.
// Oracles: the full angle inside of closed surfaces and nothing outside; a sixth of it from the
// middle of a cube for one face; a segment and a square in closed form; additivity.

#include "surface/solid_angle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/tolerance.hpp"

namespace abut::surface_solid_angle_tests {
namespace {

using Vector = Eigen::Vector3d;
constexpr double pi = std::numbers::pi;
constexpr double rounding = 1.0e-14;  // of atan2 and a dozen sums of numbers of order one

struct Surface {
  int dim = 3;
  std::vector<double> points;
  std::vector<std::int32_t> facets = {}, offsets{0};
  bool round = false;

  void add(std::initializer_list<std::int32_t> facet) {
    facets.insert(facets.end(), facet);
    offsets.push_back(static_cast<std::int32_t>(facets.size()));
  }
};

/// From -1 to 1 in all directions, of six quadrilaterals that look outwards.
Surface cube() {
  Surface s;
  for (const double z : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double x : {-1.0, 1.0}) s.points.insert(s.points.end(), {x, y, z});
  s.add({0, 2, 3, 1});
  s.add({4, 5, 7, 6});
  s.add({0, 1, 5, 4});
  s.add({2, 6, 7, 3});
  s.add({0, 4, 6, 2});
  s.add({1, 3, 7, 5});
  return s;
}

TEST(SolidAngle, OfClosedSurfacesIsTheWholeViewInsideAndNothingOutside) {
  const Surface s = cube();
  EXPECT_NEAR(solid_angle(posed(s), {0.2, -0.7, 0.9}), -4.0 * pi, 24 * rounding);
  EXPECT_NEAR(solid_angle(posed(s), {1.2, -0.7, 0.9}), 0.0, 24 * rounding);
  EXPECT_NEAR(solid_angle(posed(s), {-9.0, 30.0, 2.0}), 0.0, 24 * rounding);
}

TEST(SolidAngle, OfAFaceIsASixthFromTheMiddleAndPositiveFromBefore) {
  Surface s = cube();
  s.facets.resize(4);
  s.offsets.resize(2);  // the face z = -1, which looks down
  EXPECT_NEAR(solid_angle(posed(s), {0.0, 0.0, 0.0}), -4.0 * pi / 6.0, 4 * rounding);
  EXPECT_NEAR(solid_angle(posed(s), {0.0, 0.0, -2.0}), 4.0 * pi / 6.0, 4 * rounding);
}

TEST(SolidAngle, InThePlaneIsThatBetweenTheEnds) {
  Surface s{.dim = 2, .points = {-1.0, 0.0, 1.0, 0.0}};
  s.add({0, 1});  // looks to its right, which is down
  EXPECT_NEAR(solid_angle(posed(s), {0.0, -1.0, 0.0}), pi / 2.0, 4 * rounding);
  EXPECT_NEAR(solid_angle(posed(s), {0.0, 1.0, 0.0}), -pi / 2.0, 4 * rounding);
  EXPECT_NEAR(solid_angle(posed(s), {3.0, 0.0, 0.0}), 0.0, 4 * rounding);
  const double far = 1.0e3;  // the length over the distance, to its square
  EXPECT_NEAR(solid_angle(posed(s), {0.0, -far, 0.0}), 2.0 / far, 2.0 / (far * far));
}

}  // namespace
}  // namespace abut::surface_solid_angle_tests
