// Goal: the part of a partner's surface that contact looks at holds all that may come near, however
// both move, and little else. Oracle: the pairs of facets of the whole surface.

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "subdomain_solver/contact/near_surface.hpp"
#include "tests/support/surfaces.hpp"

namespace abut::solver_near_surface_tests {
namespace {

PortGeometry port(const SurfaceMesh& mesh) {
  PortGeometry geometry;
  geometry.dim = mesh.dim;
  geometry.points = mesh.points;
  geometry.facets = mesh.facets;
  geometry.offsets = mesh.offsets;
  return geometry;
}

std::vector<FacetPair> pairs(const PosedSurface& k, const PosedSurface& n, double reach) {
  BoxTree own, other;
  build(own, k, reach);
  build(other, n, 0.0);
  std::vector<FacetPair> found;
  overlapping_pairs(own, other, found);
  return found;
}

/// The nodes of a facet, in numbers of the whole.
std::vector<std::int32_t> nodes(const NearSurface& part, int facet) {
  std::vector<std::int32_t> out;
  for (const std::int32_t node : posed(part).nodes(facet)) out.push_back(part.in_whole(node));
  return out;
}

/// A patch of 3 x 3 facets wanders over a plate of 24 x 24, which heaves.
TEST(NearSurface, HoldsAllThatMayComeNearAndLittleElse) {
  const auto place = [](double size) {
    return [size](double u, double v) { return Eigen::Vector3d(size * u, size * v, 0.0); };
  };
  const PortGeometry whole = port(grid(24, 24, place(24.0), false, false));
  const PortGeometry own = port(grid(3, 3, place(3.0), false, true));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> step(-0.3, 0.3);
  NearSurface part(whole, own);
  std::vector<double> pose = own.points, u(whole.points.size(), 0.0);
  constexpr double reach = 1.0;
  constexpr int poses = 400;
  const std::vector<std::int32_t> pressed = {24 * 25};  // a corner, far from where the patch begins
  int renewals = 0;
  Eigen::Vector3d at(10.0, 10.0, 0.5);
  for (int i = 0; i < poses; ++i) {
    for (int d = 0; d < 2; ++d) at[d] = std::clamp(at[d] + step(random), -2.0, 23.0);
    for (std::size_t v = 0; v < pose.size(); ++v) pose[v] = own.points[v] + at[v % 3];
    for (std::size_t v = 2; v < u.size(); v += 3)
      u[v] = 0.4 * std::sin(0.05 * i + 0.3 * whole.points[v - 2]);
    part.follow(u);
    if (!part.holds(pose, reach)) {
      part.find(pose, reach, pressed, false);
      ++renewals;
    }
    std::vector<double> all = whole.points, near = part.points;
    for (std::size_t v = 0; v < all.size(); ++v) all[v] += u[v];
    for (std::size_t v = 0; v < near.size(); ++v) near[v] += u[part.values()[v]];
    const std::vector<FacetPair> expected = pairs(posed(own, pose), posed(whole, all), reach);
    const std::vector<FacetPair> found = pairs(posed(own, pose), posed(part, near), reach);
    ASSERT_EQ(found.size(), expected.size()) << "pose " << i;
    for (std::size_t p = 0; p < found.size(); ++p) {
      EXPECT_EQ(found[p].k, expected[p].k);
      const std::span<const std::int32_t> of_whole = posed(whole).nodes(expected[p].n);
      EXPECT_TRUE(std::ranges::equal(nodes(part, found[p].n), of_whole)) << "pose " << i;
    }
    ASSERT_GE(part.in_part(pressed[0]), 0);
    ASSERT_TRUE(std::ranges::is_sorted(part.listed()));
    // Twice the reach and what both have moved by around 3 x 3 facets.
    EXPECT_LE(posed(part).facet_count(), 144) << "pose " << i;
  }
  EXPECT_GT(renewals, 1);
  EXPECT_LT(renewals, poses / 2);  // a margin of as much again as the reach
}

TEST(NearSurface, OfAPartnerFarAwayIsOnePoint) {
  const auto at = [](double height) {
    return [height](double u, double v) { return Eigen::Vector3d(u, v, height); };
  };
  const PortGeometry whole = port(grid(4, 4, at(0.0), false, false));
  const PortGeometry own = port(grid(4, 4, at(100.0), false, true));
  NearSurface part(whole, own);
  const std::vector<double> u(whole.points.size(), 0.0);
  part.follow(u);
  part.find(own.points, 1.0, {}, false);
  EXPECT_TRUE(part.stands());
  EXPECT_EQ(part.listed(), std::vector<std::int32_t>{0});  // an empty list stands for all
  EXPECT_EQ(posed(part).facet_count(), 0);
  part.take_all();
  EXPECT_TRUE(part.listed().empty());
  EXPECT_EQ(part.points, whole.points);
}

}  // namespace
}  // namespace abut::solver_near_surface_tests
