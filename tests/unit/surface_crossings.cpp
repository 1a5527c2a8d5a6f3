// Goal: facets of one surface that pass through each other are found, and no others. Oracles:
// surfaces whose crossings are known by construction.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "surface/crossings.hpp"
#include "tests/support/surfaces.hpp"

namespace abut::surface_crossings_tests {
namespace {

Crossings crossings_of(const SurfaceMesh& mesh) {
  BoxTree tree;
  build(tree, mesh.pose(), 0.0);
  std::vector<FacetPair> pairs;
  return crossings(mesh.pose(), tree, pairs);
}

/// A second surface beside the first one, as one surface.
SurfaceMesh both(SurfaceMesh one, const SurfaceMesh& other) {
  const std::int32_t nodes = one.nodes();
  one.points.insert(one.points.end(), other.points.begin(), other.points.end());
  for (int f = 0; f < other.pose().facet_count(); ++f) {
    std::vector<std::int32_t> corners;
    for (const std::int32_t node : other.pose().nodes(f)) corners.push_back(nodes + node);
    one.add_facet(corners, false);
  }
  return one;
}

/// A bent strip of `turn` of a circle: its ends pass each other where it is more than 1.
SurfaceMesh spiral(double turn, double growth) {
  const double all = 2.0 * std::acos(-1.0) * turn;
  return line(
      40,
      [all, growth](double u) {
        const double r = 1.0 + growth * u;
        return Eigen::Vector2d(r * std::cos(all * u), r * std::sin(all * u));
      },
      false);
}

TEST(Crossings, OfALineInThePlane) {
  EXPECT_EQ(crossings_of(spiral(0.9, 0.0)).count, 0);
  EXPECT_EQ(crossings_of(spiral(1.1, 0.2)).count, 0);  // passes outside of its begin
  const SurfaceMesh eight = line(
      41,
      [](double u) {  // no node lies where it meets itself
        const double t = 6.2 * u;
        return Eigen::Vector2d(std::sin(t), std::sin(t) * std::cos(t));
      },
      false);
  EXPECT_EQ(crossings_of(eight).count, 1);
}

TEST(Crossings, NotOfFacetsThatLieOnEachOther) {
  const auto along = [](double u) { return Eigen::Vector2d(u, 0.0); };
  EXPECT_EQ(crossings_of(both(line(7, along, false), line(5, along, true))).count, 0);
  for (const bool triangles : {false, true}) {
    const auto flat = [](double u, double v) { return Eigen::Vector3d(u, v, 0.0); };
    EXPECT_EQ(
        crossings_of(both(grid(4, 4, flat, triangles, false), grid(3, 3, flat, triangles, true)))
            .count,
        0);
  }
}

TEST(Crossings, OfSheetsInSpace) {
  const auto flat = [](double u, double v) { return Eigen::Vector3d(u, v, 0.0); };
  for (const bool triangles : {false, true}) {
    const SurfaceMesh sheet = grid(4, 4, flat, triangles, false);
    EXPECT_EQ(crossings_of(sheet).count, 0);
    for (const double place : {0.1, 0.125, 0.3, 0.625}) {  // 0.125: through the diagonals' middle
      const auto upright = [place](double u, double v) {
        return Eigen::Vector3d(place, 0.05 + 0.9 * u, v - 0.45);
      };
      const SurfaceMesh cut = both(sheet, grid(3, 3, upright, triangles, false));
      const Crossings found = crossings_of(cut);
      EXPECT_GE(found.count, 4) << triangles << place;  // all along one column of the sheet
      EXPECT_LT(found.first.k, sheet.pose().facet_count());
      EXPECT_GE(found.first.n, sheet.pose().facet_count());
      const auto above = [place](double u, double v) {
        return Eigen::Vector3d(place, 0.05 + 0.9 * u, v + 1.0e-5);
      };
      EXPECT_EQ(crossings_of(both(sheet, grid(3, 3, above, triangles, false))).count, 0);
    }
  }
}

}  // namespace
}  // namespace abut::surface_crossings_tests
