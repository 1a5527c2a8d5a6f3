// Goal: bodies that are in each other are found with depth and place, however they lie: with nodes
// in each other, flush, one in the other, the same, crossing without a node inside, thin, open; and
// bodies that only touch are apart.
// Oracles: blocks whose overlap is a block, by construction; both orders say the same.

#include "surface/overlap_places.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tests/support/feature_cases.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::surface_overlap_places_tests {
namespace {

using Vector = Eigen::Vector3d;

constexpr double allowed = 1.0e-9;  // [m] far above the rounding of places of size 3

std::vector<OverlapPlace> shared(const SurfaceMesh& one, const SurfaceMesh& other,
                                 double reach = 1.0) {
  return overlap_places(one.pose(), other.pose(), {{allowed, allowed}, reach});
}

Eigen::Matrix3d turn(int dim, bool turned) {
  if (!turned) return Eigen::Matrix3d::Identity();
  const Vector axis = dim == 2 ? Vector::UnitZ() : Vector(0.3, -0.5, 0.8).normalized();
  return Eigen::AngleAxisd(0.7, axis).toRotationMatrix();
}

struct Pair {
  std::string name;
  Vector low, high;                // of a block beside that from 0 to 1
  double least = 0.0, most = 0.0;  // [m] depth that may be told; 0: they are apart
};

/// Depths of blocks are at most half of what they have in common, and of an edge what frees it.
const std::vector<Pair>& pairs() {
  static const std::vector<Pair> all{
      {"face on face", {0, 0, 1}, {1, 1, 2}},
      {"shifted on a face", {0.3, 0.2, 1}, {1.3, 1.2, 2}},
      {"small on large", {0.3, 0.2, 1}, {0.5, 0.4, 1.2}},
      {"edge on edge", {1, 0, 1}, {2, 1, 2}},
      {"corner on corner", {1, 1, 1}, {2, 2, 2}},
      {"beside", {1.001, 0, 0}, {2, 1, 1}},
      {"flush overlap", {0, 0, 0.9}, {1, 1, 1.9}, 0.09, 0.11},
      {"corner inside", {0.8, 0.7, 0.9}, {1.8, 1.7, 1.9}, 0.09, 0.11},
      {"inside", {0.4, 0.3, 0.4}, {0.5, 0.5, 0.6}, 0.29, 0.51},
      {"far inside", {0.499, 0.499, 0.499}, {0.501, 0.501, 0.501}, 0.49, 0.51},
      {"the same", {0, 0, 0}, {1, 1, 1}, 0.1, 0.51},
      {"inside and flush", {0.2, 0.3, 0}, {0.8, 0.7, 0.5}, 0.1, 0.51},
      {"crossing", {0.4, -3, -3}, {0.6, 3, 0.5}, 0.09, 0.75},
      {"through", {0.4, 0.3, -3}, {0.6, 0.7, 3}, 0.09, 0.75},
      {"thin through", {0.499, -3, -3}, {0.501, 3, 3}, 0.0009, 0.75}};
  return all;
}

std::array<SurfaceMesh, 2> blocks(const Pair& pair, int dim, bool turned) {
  const auto flat = [dim](const Vector& x) { return dim == 2 ? Vector(x.x(), x.z(), 0.0) : x; };
  std::array<SurfaceMesh, 2> made{block(dim, flat(Vector::Zero()), flat({1, 1, 1})),
                                  block(dim, flat(pair.low), flat(pair.high))};
  for (SurfaceMesh& mesh : made)
    mesh = moved(mesh, turn(dim, turned), {0.1, 0.2, dim == 2 ? 0.0 : 0.3});
  return made;
}

TEST(OverlapPlaces, AreThoseOfBlocks) {
  for (const Pair& pair : pairs()) {
    for (const int dim : {2, 3}) {
      for (const bool turned : {false, true}) {
        const auto [one, other] = blocks(pair, dim, turned);
        for (const bool swapped : {false, true}) {
          const std::vector<OverlapPlace> found = swapped ? shared(other, one) : shared(one, other);
          const std::string what = pair.name + (dim == 2 ? " in the plane" : " in space");
          ASSERT_EQ(found.empty(), pair.most == 0.0) << what << " " << turned << " " << swapped;
          if (found.empty()) continue;
          EXPECT_GE(found.front().depth, pair.least) << what << " " << turned << " " << swapped;
          EXPECT_LE(found.front().depth, pair.most) << what << " " << turned << " " << swapped;
        }
      }
    }
  }
}

/// Places are in both blocks: what is told is where it is.
TEST(OverlapPlaces, LieInBothBodies) {
  for (const Pair& pair : pairs()) {
    for (const int dim : {2, 3}) {
      const auto [one, other] = blocks(pair, dim, true);
      for (const OverlapPlace& place : shared(one, other)) {
        const Vector x =
            turn(dim, true).transpose() * (place.place - Vector(0.1, 0.2, dim == 2 ? 0.0 : 0.3));
        const double room = roundoff(16.0, 3.0);
        for (int i = 0; i < dim; ++i) {
          const int axis = dim == 2 && i == 1 ? 2 : i;
          EXPECT_GE(x[i], std::max(0.0, pair.low[axis]) - room) << pair.name << dim;
          EXPECT_LE(x[i], std::min(1.0, pair.high[axis]) + room) << pair.name << dim;
        }
      }
    }
  }
}

/// A floor that encloses nothing: what is behind it by less than reach is in it, where it faces it.
TEST(OverlapPlaces, BehindAnOpenSurfaceAreWithinReach) {
  const auto floor = [](double u, double v) { return Vector(4.0 * u - 2.0, 4.0 * v - 2.0, 0.0); };
  const SurfaceMesh open = grid(4, 4, floor, false, false);
  const auto box_at = [](double z) { return block(3, {-0.2, -0.2, z}, {0.3, 0.3, z + 0.5}); };
  EXPECT_TRUE(shared(open, box_at(0.0)).empty());
  const std::vector<OverlapPlace> found = shared(open, box_at(-0.1));
  ASSERT_FALSE(found.empty());
  EXPECT_NEAR(found.front().depth, 0.1, roundoff(8.0, 1.0));
  EXPECT_TRUE(std::ranges::any_of(found, [](const OverlapPlace& p) { return p.surface == 1; }));
  EXPECT_FALSE(shared(open, box_at(-0.9)).empty());
  EXPECT_TRUE(shared(open, box_at(-2.0)).empty()) << "a body below a sheet is beside it";
  EXPECT_TRUE(shared(open, block(3, {2.1, -0.2, -0.1}, {2.5, 0.3, 0.4})).empty()) << "beside it";
  // a needle through a facet, no node of either over the other within reach
  const std::vector<OverlapPlace> needle = shared(open, block(3, {0.4, 0.4, -3}, {0.5, 0.5, 3}));
  ASSERT_FALSE(needle.empty());
  EXPECT_EQ(needle.front().what, OverlapPlace::What::edge);
}

/// Thin arches, one above the other: the inner face of one lies less than a facet behind the outer
/// one, and is no part of its body.
TEST(OverlapPlaces, AreNoneOfThinArchesThatAreApart) {
  const auto arch = [](double inner, double outer, int cells) {
    SurfaceMesh mesh;
    mesh.dim = 2;
    for (const double radius : {outer, inner})
      for (int i = 0; i <= cells; ++i) {
        const double part = radius == outer ? i : cells - i;
        const double angle = std::acos(-1.0) * part / cells;
        mesh.points.insert(mesh.points.end(), {radius * std::cos(angle), radius * std::sin(angle)});
      }
    const int count = 2 * (cells + 1);
    for (int i = 0; i < count; ++i) mesh.add_facet({i, (i + 1) % count}, false);
    return mesh;
  };
  for (const int cells : {6, 12, 40}) {
    const double rise = 1.0 - std::cos(0.5 * std::acos(-1.0) / cells);
    const SurfaceMesh below = arch(0.8, 1.0, 16);
    const double inner = 1.0 / (1.0 - rise) + 0.01;
    EXPECT_TRUE(shared(below, arch(inner, inner + 0.2, cells)).empty()) << cells;
    const std::vector<OverlapPlace> low = shared(below, arch(0.95, 1.3, cells));
    ASSERT_FALSE(low.empty());
    EXPECT_LE(low.front().depth, 0.05 + 0.95 * rise + roundoff(8.0, 1.0)) << cells;
  }
}

TEST(OverlapPlaces, PartedPlacesAreTheDeepestOfTheirSurroundings) {
  std::vector<OverlapPlace> places;
  for (const double x : {0.0, 0.1, 5.0, 0.2, 5.1, 9.0})
    places.push_back({1.0 / static_cast<double>(places.size() + 1), {x, 0.0, 0.0}});
  const std::vector<OverlapPlace> parted = parted_places(places, 1.0, 2);
  ASSERT_EQ(parted.size(), 2u);
  EXPECT_EQ(parted[0].place.x(), 0.0);
  EXPECT_EQ(parted[1].place.x(), 5.0);
  EXPECT_EQ(parted_places(places, 1.0, 9).size(), 3u);
}

/// What is in the hole of a ring is behind its outer surface, and before the inner one.
TEST(OverlapPlaces, InAHoleAreBeforeItsSurface) {
  SurfaceMesh hole = block(2, {0, 0, 0}, {1, 1, 0});
  for (std::size_t k = 0; k < hole.facets.size(); k += 2)
    std::swap(hole.facets[k], hole.facets[k + 1]);  // looks inwards, out of the ring
  const Vector in(0.4, 0.3, 0.0), beside(1.2, 0.3, 0.0);
  EXPECT_TRUE(is_before(hole.pose(), in, 1.0));
  EXPECT_FALSE(is_before(hole.pose(), in, 0.2));      // the outer surface is nearer
  EXPECT_FALSE(is_before(hole.pose(), beside, 1.0));  // in the ring
  hole.facets.resize(hole.facets.size() - 2);
  hole.offsets.pop_back();
  EXPECT_FALSE(is_before(hole.pose(), in, 1.0));  // of a surface that ends, nothing is known
}

}  // namespace
}  // namespace abut::surface_overlap_places_tests
