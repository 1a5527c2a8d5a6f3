// Goal: rows of a partner's nodes, where it has edges, are told as those of the surface that finds
// the contact. Oracle: the definition of SurfaceRows.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "subdomain_solver/contact/edged_surface.hpp"
#include "tests/support/surfaces.hpp"

namespace abut::solver_edged_surface_tests {
namespace {

/// A face of two segments along the x-axis; a wedge of sixteen stands on it, turned by 32 degrees.
TEST(EdgedSurface, RowsNameNodesOfTheFinder) {
  const SurfaceMesh face = line(
      2, [](double u) { return Eigen::Vector2d(1.0 - 2.0 * u, 0.0); }, false);
  const auto angle = [](double u) {
    return Eigen::Vector2d(2.0 * u - 1.0, 0.29 * std::abs(2.0 * u - 1.0));
  };
  const SurfaceMesh corner = line(16, angle, false);
  PortGeometry partner;
  partner.dim = 2;
  partner.points = corner.points;
  partner.facets = corner.facets;
  partner.offsets = corner.offsets;
  EdgedSurface edged(partner, 1.0, 0.0);
  ASSERT_TRUE(edged.any());
  BoxTree tree;
  build(tree, face.pose(), 1.0);
  SurfaceRows rows;
  edged.join(partner.points, face.pose(), tree, 0.0, [](const FacetPair&) { return false; }, rows);
  ASSERT_GT(rows.count(), face.nodes());
  for (int r = 0; r < rows.count(); ++r) {
    const std::int32_t node = rows.nodes[r];
    ASSERT_LT(node, face.nodes());
    // The node of most weight in the row.
    double most = 0.0, its = 0.0;
    for (std::int32_t e = rows.k.offsets[r]; e < rows.k.offsets[index(r) + 1]; ++e) {
      most = std::max(most, rows.k.values[e]);
      if (rows.k.columns[e] == node) its = rows.k.values[e];
    }
    EXPECT_EQ(its, most);
  }
}

}  // namespace
}  // namespace abut::solver_edged_surface_tests
