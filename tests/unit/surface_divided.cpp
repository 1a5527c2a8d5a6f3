// Goal: a divided surface is the same surface, with nodes that neighbours share.
// Oracle: closed forms of counts and areas; a finer grid of the same plane; identities.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "surface/divided_surface.hpp"
#include "surface/sharp_nodes.hpp"
#include "tests/support/surfaces.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::surface_divided_tests {
namespace {

const double exact = roundoff(200.0, 2.0);  // sums over some hundred cells of lengths to 2

std::vector<double> points_of(const DividedSurface& divided, const SurfaceMesh& mesh) {
  std::vector<double> points(index(divided.node_count() * divided.dim));
  apply(divided.nodes, divided.dim, mesh.points, points);
  return points;
}

Eigen::Vector3d area_of(const PosedSurface& surface) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int f = 0; f < surface.facet_count(); ++f) sum += area_vector(corners(surface, f));
  return sum;
}

TEST(DividedSurface, IsTheSameSurfaceWithSharedNodes) {
  // Bilinear, so that facets are ruled: what a facet's parts show is what the facet shows.
  const auto place = [](double u, double v) { return Eigen::Vector3d(u, 2.0 * v, 0.3 * u * v); };
  const auto curve = [](double u) { return Eigen::Vector2d(u, u * u); };
  for (const int parts : {1, 2, 5}) {
    const SurfaceMesh meshes[] = {grid(3, 2, place, false, false), grid(3, 2, place, true, true),
                                  line(4, curve, false)};
    const int nodes[] = {(3 * parts + 1) * (2 * parts + 1), (3 * parts + 1) * (2 * parts + 1),
                         4 * parts + 1};
    for (int i = 0; i < 3; ++i) {
      const PosedSurface whole = meshes[i].pose();
      const DividedSurface d = divided(whole, parts);
      const std::vector<double> points = points_of(d, meshes[i]);
      const PosedSurface pose{d.dim, points, d.facets, d.offsets};
      EXPECT_EQ(d.node_count(), nodes[i]);
      EXPECT_EQ(pose.facet_count(), whole.facet_count() * (whole.dim == 2 ? parts : parts * parts));
      EXPECT_NEAR((area_of(pose) - area_of(whole)).norm(), 0.0, exact);
      EXPECT_NEAR(longest_edge(pose), longest_edge(whole) / parts, exact);
      for (int r = 0; r < d.node_count(); ++r) {
        double sum = 0.0;
        for (std::int32_t e = d.nodes.offsets[r]; e < d.nodes.offsets[r + 1]; ++e)
          sum += d.nodes.values[e];
        EXPECT_NEAR(sum, 1.0, exact);
      }
    }
  }
}

TEST(DividedSurface, IsDividedToASize) {
  const SurfaceMesh mesh = line(
      4, [](double u) { return Eigen::Vector2d(u, 0.0); }, false);  // edges of 1/4
  EXPECT_EQ(parts_for(mesh.pose(), 0.3), 1);
  EXPECT_EQ(parts_for(mesh.pose(), 0.1), 3);
  // More than an int counts: as many as it counts, which scenes are refused for.
  EXPECT_EQ(parts_for(mesh.pose(), 1.0e-12), std::numeric_limits<int>::max());
}

TEST(DividedSurface, KeepsItsEdgesSharp) {
  const auto ridge = [](double u, double v) { return Eigen::Vector3d(u, v, -std::abs(u - 0.5)); };
  const SurfaceMesh mesh = grid(4, 2, ridge, false, false);
  const DividedSurface d = divided(mesh.pose(), 3);
  const std::vector<double> points = points_of(d, mesh);
  const PosedSurface pose{d.dim, points, d.facets, d.offsets};
  const std::vector<std::int32_t> sharp = sharp_nodes(pose, sharp_edge);
  EXPECT_EQ(sharp.size(), 7u);
  for (const std::int32_t node : sharp) EXPECT_NEAR(pose.point(node).x(), 0.5, exact);
}

}  // namespace
}  // namespace abut::surface_divided_tests
