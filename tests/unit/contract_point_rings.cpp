// Points of a surface by facets between them. Oracle: a lattice of squares, where points that k
// facets part at most are those of a square of 2 k + 1 points around one.

#include "contract/point_rings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "base/index.hpp"

namespace abut::point_rings_tests {
namespace {

constexpr int side = 9;

struct Lattice {
  std::vector<std::int32_t> facets, offsets{0};
  Lattice() {
    for (int y = 0; y + 1 < side; ++y)
      for (int x = 0; x + 1 < side; ++x) {
        const int p = y * side + x;
        facets.insert(facets.end(), {p, p + 1, p + side + 1, p + side});
        offsets.push_back(static_cast<std::int32_t>(facets.size()));
      }
  }
};

int between(int p, int q) {
  return std::max(std::abs(p % side - q % side), std::abs(p / side - q / side));
}

TEST(PointRings, AreSquaresOfALattice) {
  const Lattice lattice;
  PointRings rings(side * side, lattice.facets, lattice.offsets);
  ASSERT_EQ(rings.count(), side * side);
  for (const int k : {0, 1, 3}) {
    for (std::int32_t p = 0; p < side * side; p += 7) {
      std::vector<std::int32_t> expected;
      for (std::int32_t q = 0; q < side * side; ++q)
        if (between(p, q) <= k) expected.push_back(q);
      const std::span<const std::int32_t> found = rings.around(p, k);
      EXPECT_EQ(std::vector<std::int32_t>(found.begin(), found.end()), expected);
    }
  }
}

// What answers one point of a colour answers no other one.
TEST(PointRings, ColoursHaveNothingInCommon) {
  const Lattice lattice;
  PointRings rings(side * side, lattice.facets, lattice.offsets);
  for (const int k : {1, 2}) {
    const std::vector<int> colours = rings.colours(k);
    for (int p = 0; p < side * side; ++p)
      for (int q = 0; q < p; ++q)
        EXPECT_TRUE(colours[index(p)] != colours[index(q)] || between(p, q) > 2 * k);
    EXPECT_LE(*std::ranges::max_element(colours), (4 * k + 1) * (4 * k + 1));
  }
}

// Of a part of the points, by numbers in the part: ways lead through these alone.
TEST(PointRings, OfAPartAreNumberedInIt) {
  const Lattice lattice;
  const std::vector<std::int32_t> among = {0, 1, 2, 4, 5, 9};  // 3 is missing between 2 and 4
  PointRings rings(side * side, lattice.facets, lattice.offsets, among);
  ASSERT_EQ(rings.count(), 6);
  const std::span<const std::int32_t> found = rings.around(0, 5);
  EXPECT_EQ(std::vector<std::int32_t>(found.begin(), found.end()),
            (std::vector<std::int32_t>{0, 1, 2, 5}));
}

}  // namespace
}  // namespace abut::point_rings_tests
