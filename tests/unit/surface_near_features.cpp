// Goal: a skin has every simplex of its surfaces once, and near features are exactly those pairs
// that the boxes of their ways bring within reach.
// Oracles: counts of Euler's formula; every pair tested; distances sampled on the way.

#include "surface/near_features.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/support/feature_cases.hpp"

namespace abut::surface_near_features_tests {
namespace {

using Vector = Eigen::Vector3d;
using Points = std::vector<Vector>;

TEST(Skin, HasEverySimplexOnce) {
  SurfaceMesh with_idle = block(3, {0, 0, 0}, {1, 1, 1});
  with_idle.points.insert(with_idle.points.begin() + 24, {5.0, 5.0, 5.0});  // no facet has it
  const Skin skin = skin_of({with_idle, block(3, {2, 0, 0}, {3, 1, 1})});
  EXPECT_EQ(skin.facets.size(), 24u);
  EXPECT_EQ(skin.edges.size(), 36u);  // of each: 12 and 6 diagonals
  EXPECT_EQ(skin.nodes.size(), 16u);
  EXPECT_EQ(skin.groups, 2);
  EXPECT_EQ(skin.point_count(), 17);
  EXPECT_EQ(std::ranges::count(skin.nodes, 8), 0);
  EXPECT_EQ(skin.group[8], 0);
  EXPECT_EQ(skin.group[9], 1);
  const std::array<std::int32_t, 3> first{0, 2, 3}, second{0, 3, 1};
  EXPECT_EQ(skin.facets[0], first);
  EXPECT_EQ(skin.facets[1], second);
  EXPECT_TRUE(std::ranges::is_sorted(skin.edges));
  EXPECT_EQ(std::set(skin.edges.begin(), skin.edges.end()).size(), skin.edges.size());
}

TEST(Skin, OfThePlaneHasNoEdges) {
  const Skin skin = skin_of({block(2, {0, 0, 0}, {1, 1, 0}), block(2, {2, 0, 0}, {3, 1, 0})});
  EXPECT_EQ(skin.facets.size(), 8u);
  EXPECT_TRUE(skin.edges.empty());
  EXPECT_EQ(skin.nodes.size(), 8u);
  const std::array<std::int32_t, 3> last{6, 4, -1};
  EXPECT_EQ(skin.facets.back(), last);
}

/// Crumpled sheets of quadrilaterals and of triangles, or lines of the plane, all about one place.
std::vector<SurfaceMesh> some_meshes(DrawNumbers& draw, int dim) {
  std::vector<SurfaceMesh> meshes;
  for (int m = 0; m < 4; ++m) {
    const Vector by = drawn_point(draw, dim, 0.5);
    if (dim == 2) {
      meshes.push_back(line(
          12,
          [&](double u) {
            return Eigen::Vector2d(u + by.x() + draw(-0.1, 0.1), by.y() + draw(-0.1, 0.1));
          },
          false));
      continue;
    }
    meshes.push_back(grid(
        5, 4,
        [&](double u, double v) -> Vector {
          return Vector(u + by.x(), v + by.y(), by.z()) + drawn_point(draw, 3, 0.1);
        },
        m % 2 == 0, false));
  }
  return meshes;
}

bool within(const FeaturePair& pair, const Points& from, const Points& to, double reach) {
  const std::size_t first = static_cast<std::size_t>(pair.first_side());
  for (int d = 0; d < 3; ++d) {
    double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
    for (std::size_t i = 0; i < 4; ++i) {
      if (pair.points[i] < 0) continue;
      const int side = i < first ? 0 : 1;
      for (const Points* points : {&from, &to}) {
        low[side] = std::min(low[side], (*points)[pair.points[i]][d]);
        high[side] = std::max(high[side], (*points)[pair.points[i]][d]);
      }
    }
    if (low[0] - reach > high[1] || low[1] - reach > high[0]) return false;
  }
  return true;
}

std::vector<FeaturePair> by_every_pair(const Skin& skin, const Points& from, const Points& to,
                                       double reach, const FeatureChoice& choice) {
  std::vector<FeaturePair> pairs;
  const auto add = [&](const FeaturePair& pair) {
    const int g = skin.group[pair.points[0]], h = skin.group[pair.points[2]];
    if (choice.allowed.empty() ? g == h : !choice.allowed[g * skin.groups + h]) return;
    std::set<std::int32_t> used;
    bool given = true;
    std::size_t count = 0;
    for (const std::int32_t p : pair.points) {
      if (p < 0) continue;
      used.insert(p);
      ++count;
      given = given && !choice.prescribed.empty() && choice.prescribed[p];
    }
    if (used.size() == count && !given && within(pair, from, to, reach)) pairs.push_back(pair);
  };
  for (const std::int32_t node : skin.nodes)
    for (const auto& f : skin.facets) add({FeatureKind::node_facet, {node, f[0], f[1], f[2]}});
  for (std::size_t i = 0; i < skin.edges.size(); ++i)
    for (std::size_t j = i + 1; j < skin.edges.size(); ++j)
      add({FeatureKind::edge_edge,
           {skin.edges[i][0], skin.edges[i][1], skin.edges[j][0], skin.edges[j][1]}});
  std::ranges::sort(pairs);
  return pairs;
}

/// Groups against others, against all, against some and themselves; with and without points whose
/// motion is given.
std::vector<FeatureChoice> some_choices(DrawNumbers& draw, const Skin& skin) {
  std::vector<std::uint8_t> some(static_cast<std::size_t>(skin.groups * skin.groups), 0);
  for (int g = 0; g < skin.groups; ++g)
    for (int h = 0; h <= g; ++h)
      some[g * skin.groups + h] = some[h * skin.groups + g] = draw(0, 1) < 0.5;
  std::vector<std::uint8_t> prescribed;
  for (std::size_t i = 0; i < skin.group.size(); ++i) prescribed.push_back(draw(0, 1) < 0.7);
  const std::vector<std::uint8_t> all(some.size(), 1);
  return {{}, {all, {}}, {some, {}}, {{}, prescribed}, {all, prescribed}};
}

TEST(NearFeatures, AreThoseOfEveryPair) {
  DrawNumbers draw(1);
  std::size_t found = 0;
  for (const int dim : {2, 3}) {
    for (int k = 0; k < 4; ++k) {
      const std::vector<SurfaceMesh> meshes = some_meshes(draw, dim);
      const Skin skin = skin_of(meshes);
      Points from = points_of(meshes), to = from;
      SkinTrees trees(skin, from);
      for (Vector& x : to) x += drawn_point(draw, dim, 0.1 * k);
      for (Vector& x : from) x += drawn_point(draw, dim, 0.1 * k);
      for (const double reach : {0.0, 0.01, 0.3}) {
        for (const FeatureChoice& choice : some_choices(draw, skin)) {
          std::vector<FeaturePair> pairs;
          near_features(trees, from, to, reach, choice, pairs);
          EXPECT_TRUE(pairs == by_every_pair(skin, from, to, reach, choice));
          found += pairs.size();
        }
      }
    }
  }
  EXPECT_GT(found, 10000u);
}

/// Whatever comes nearer than the reach on the way is among them.
TEST(NearFeatures, MissNothingThatComesNear) {
  DrawNumbers draw(2);
  for (const int dim : {2, 3}) {
    const std::vector<SurfaceMesh> meshes = some_meshes(draw, dim);
    const Skin skin = skin_of(meshes);
    const Points from = points_of(meshes);
    Points to = from, between = from;
    for (Vector& x : to) x += drawn_point(draw, dim, 0.2);
    constexpr double reach = 0.02;
    SkinTrees trees(skin, from);
    std::vector<FeaturePair> pairs;
    near_features(trees, from, to, reach, {}, pairs);
    int near = 0;
    for (int i = 0; i <= 10; ++i) {
      for (std::size_t p = 0; p < between.size(); ++p)
        between[p] = from[p] + 0.1 * i * (to[p] - from[p]);
      for (const FeaturePair& pair : by_every_pair(skin, between, between, reach, {})) {
        if (feature_distance(pair.kind, dim, places(pair, between)).distance > reach) continue;
        ++near;
        EXPECT_TRUE(std::ranges::binary_search(pairs, pair));
      }
    }
    EXPECT_GT(near, 100);
  }
}

TEST(NearFeatures, KeepTheirMemory) {
  DrawNumbers draw(3);
  const std::vector<SurfaceMesh> meshes = some_meshes(draw, 3);
  const Skin skin = skin_of(meshes);
  const Points points = points_of(meshes);
  SkinTrees trees(skin, points);
  std::vector<FeaturePair> pairs;
  near_features(trees, points, points, 0.3, {}, pairs);
  const FeaturePair* begin = pairs.data();
  const std::vector<FeaturePair> first = pairs;
  near_features(trees, points, points, 0.3, {}, pairs);
  EXPECT_EQ(pairs.data(), begin);
  EXPECT_EQ(pairs, first);
}

TEST(SkinTrees, TellTheClosestFacet) {
  DrawNumbers draw(4);
  for (const int dim : {2, 3}) {
    const std::vector<SurfaceMesh> meshes = some_meshes(draw, dim);
    const Skin skin = skin_of(meshes);
    const Points points = points_of(meshes);
    SkinTrees trees(skin, points);
    for (int k = 0; k < 400; ++k) {
      const Vector x = k % 4 == 0 ? points[k % points.size()] : drawn_point(draw, dim, 2.0);
      const int group = k % skin.groups;
      double least = 1e9;
      std::int32_t closest = -1;
      for (std::size_t f = 0; f < skin.facets.size(); ++f) {
        const FeaturePair pair{FeatureKind::node_facet,
                               {0, skin.facets[f][0], skin.facets[f][1], skin.facets[f][2]}};
        if (skin.group[pair.points[1]] != group) continue;
        FeaturePoints at = places(pair, points);
        at[0] = x;
        const double d = feature_distance(pair.kind, dim, at).distance;
        if (d < least) {
          least = d;
          closest = static_cast<std::int32_t>(f);
        }
      }
      EXPECT_EQ(trees.closest_facet(group, points, x, 10.0), closest);
      EXPECT_EQ(trees.closest_facet(group, points, x, least), closest);
      EXPECT_EQ(trees.closest_facet(group, points, x, 0.99 * least - 1e-9), -1);
    }
  }
}

}  // namespace
}  // namespace abut::surface_near_features_tests
