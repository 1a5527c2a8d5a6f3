// Goal: far sides of thin bodies that lie on each other are no pair of contact, and no other pair
// of facets that are behind each other is left out. Oracle: by construction.

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "surface/far_sides.hpp"

namespace abut::surface_far_sides_tests {
namespace {

/// The outside of a rectangle in the plane: facets bottom, right, top, left.
struct Rectangle {
  std::vector<double> points;
  std::vector<std::int32_t> facets{0, 1, 1, 2, 2, 3, 3, 0}, offsets{0, 2, 4, 6, 8};

  Rectangle(double x, double y, double width, double height)
      : points{x, y, x + width, y, x + width, y + height, x, y + height} {}
  PosedSurface pose() const { return {2, points, facets, offsets}; }
};

enum Facet : std::int32_t { bottom, right, top, left };

constexpr double depth = 1.0e-3;

/// Whether a facet of one and a facet of the other are left out.
bool left_out(const Rectangle& one, const Rectangle& other, FacetPair pair = {bottom, top}) {
  std::vector<FacetPair> pairs{pair};
  FarSides sides;
  sides.leave_out(one.pose(), other.pose(), depth, pairs);
  EXPECT_EQ(pairs.empty(), sides.drops(pair));
  return pairs.empty();
}

TEST(FarSides, OfThinBodiesThatLieOnEachOtherAreLeftOut) {
  const Rectangle sheet(0.0, 0.0, 10.0, 1.0);
  const Rectangle others[] = {{0.0, 1.0, 10.0, 3.0},
                              {8.0, 1.0, 40.0, 3.0},
                              {-20.0, 1.0, 22.0, 3.0},  // over its ends
                              {4.0, 1.5, 1.0, 0.02},    // apart
                              {0.0, 0.9, 10.0, 3.0}};   // pressed in
  for (const Rectangle& other : others) {
    EXPECT_TRUE(left_out(sheet, other));
    EXPECT_FALSE(left_out(sheet, other, {top, bottom}));  // these are the sides that touch
  }
}

TEST(FarSides, SidesOfBodiesThatOverlapStay) {
  const Rectangle block(0.0, 0.0, 10.0, 10.0);
  // Its bottom is behind the other one's top, in which it is, by little or by much.
  EXPECT_FALSE(left_out(block, Rectangle(0.0, -9.9, 10.0, 10.0)));
  EXPECT_FALSE(left_out(block, Rectangle(-30.0, -8.0, 60.0, 10.0)));
  EXPECT_FALSE(left_out(block, Rectangle(4.0, -8.0, 2.0, 10.0)));   // narrow
  EXPECT_FALSE(left_out(block, Rectangle(9.9, -9.9, 10.0, 10.0)));  // by their corners alone
}

/// Of what is round a place a little inside lies far behind the planes of facets beside it.
TEST(FarSides, SidesOfRoundBodiesThatArePressedInStay) {
  Rectangle round(0.0, 0.0, 0.0, 0.0);  // an octagon about (0, 0), its top from -1 to 1
  round.points = {1.0,  -2.4, 2.4,  -1.0, 2.4,  1.0,  1.0,  2.4,
                  -1.0, 2.4,  -2.4, 1.0,  -2.4, -1.0, -1.0, -2.4};
  round.facets = {0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7, 0};
  round.offsets = {0, 2, 4, 6, 8, 10, 12, 14, 16};
  for (const std::int32_t facet : {2, 3, 4})
    for (const double x : {-3.0, -1.5, 0.0, 1.5, 3.0})
      EXPECT_FALSE(left_out({x - 1.0, 2.3, 2.0, 2.0}, round, {bottom, facet})) << facet << " " << x;
}

TEST(FarSides, WhatIsNotBehindIsNotLookedAt) {
  EXPECT_FALSE(left_out({0.0, 1.0, 10.0, 1.0}, {0.0, 0.0, 10.0, 1.0}));
  EXPECT_FALSE(left_out({0.0, 1.0 - 0.5 * depth, 10.0, 1.0}, {0.0, 0.0, 10.0, 1.0}));
}

}  // namespace
}  // namespace abut::surface_far_sides_tests
