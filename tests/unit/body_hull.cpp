// Goal: the outside of a body is the surface that contact sees, warped facets included.
// Oracle: identity of the diagonals along which both divide a quadrilateral.

#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "contract/subdomain.hpp"
#include "coordinator/body_hull.hpp"

namespace abut::body_hull_tests {
namespace {

/// A unit cube of one cell.
Grid cube() {
  return {.points = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1},
          .types = {12},
          .connectivity = {0, 1, 2, 3, 4, 5, 6, 7},
          .offsets = {0, 8}};
}

/// Its face at the top alone is a port, whose facet begins at another of its corners.
Description with_port(std::array<int, 4> order) {
  const std::vector<std::array<double, 3>> top = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  Port port{.name = "top", .geometry = {.dim = 3, .facets = {0, 1, 2, 3}, .offsets = {0, 4}}};
  for (const int corner : order)
    port.geometry.points.insert(port.geometry.points.end(), top[corner].begin(), top[corner].end());
  Description body;
  body.dim = 3;
  body.ports = {port};
  return body;
}

TEST(BodyHull, DividesQuadrilateralsAsPortsDo) {
  for (const std::array<int, 4> order : {std::array{0, 1, 2, 3}, std::array{1, 2, 3, 0},
                                         std::array{2, 3, 0, 1}, std::array{3, 0, 1, 2}}) {
    const Description body = with_port(order);
    const BodyHull hull = hull_of(body, cube());
    ASSERT_EQ(hull.offsets.size(), 7u);
    const auto place = [&hull](std::int32_t node) {
      const double* x = &hull.points[3 * static_cast<std::size_t>(node)];
      return std::array{x[0], x[1], x[2]};
    };
    int found = 0;
    for (std::size_t f = 0; f < 6; ++f) {
      const std::int32_t* n = &hull.facets[4 * f];
      if (!std::all_of(n, n + 4, [&](std::int32_t node) { return place(node)[2] == 1.0; }))
        continue;
      ++found;
      // The diagonal from (0,0) to (1,1) begins where x = y, the other one does not.
      const bool along = place(n[0])[0] == place(n[0])[1];
      EXPECT_EQ(along, order[0] % 2 == 0);
    }
    EXPECT_EQ(found, 1);
  }
}

}  // namespace
}  // namespace abut::body_hull_tests
