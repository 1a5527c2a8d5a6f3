// Goal: a way between closest points counts only where both are closest among what lies around
// them. Oracles: a flat side that goes on, a ridge that does not, in the plane and in space.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "surface/feature_surroundings.hpp"

namespace abut::surface_feature_surroundings_tests {
namespace {

constexpr double sine = 0.1;

/// Whether the surface of the pair's second side goes nearer to a node at `x`, the last point.
bool goes_nearer(const Skin& skin, std::vector<Eigen::Vector3d> points, FeaturePair pair,
                 const Eigen::Vector3d& x) {
  points.push_back(x);
  pair.points[0] = skin.point_count() - 1;
  const FeatureDistance found = feature_distance(pair.kind, skin.dim, places(pair, points));
  const Eigen::Vector3d way = found.difference(places(pair, points)) / found.distance;
  return FeatureSurroundings(skin).goes_nearer(pair, found.weights, 1, way, sine,
                                               {points, points, 0.0});
}

/// Two segments that meet in (0, 0), from (-1, down) and to (1, down), and a point of another body.
struct Roof {
  explicit Roof(double down) : points{{-1.0, -down, 0.0}, {0.0, 0.0, 0.0}, {1.0, -down, 0.0}} {
    skin.dim = 2;
    skin.facets = {{0, 1, -1}, {1, 2, -1}};
    skin.nodes = {0, 1, 2};
    skin.group = {0, 0, 0, 1};
    skin.groups = 2;
  }
  bool left_goes_nearer(double x, double y) const {
    return goes_nearer(skin, points, {FeatureKind::node_facet, {-1, 0, 1, -1}}, {x, y, 0.0});
  }
  std::vector<Eigen::Vector3d> points;
  Skin skin;
};

TEST(FeatureSurroundings, OfAFlatSideTellItsFacetsThatEndBesideANode) {
  const Roof flat(0.0);
  EXPECT_TRUE(flat.left_goes_nearer(0.01, 0.01));     // above the other facet: 45 degrees aside
  EXPECT_FALSE(flat.left_goes_nearer(-0.2, 0.01));    // above the facet itself
  EXPECT_FALSE(flat.left_goes_nearer(0.0, 0.01));     // above where they meet
  EXPECT_FALSE(flat.left_goes_nearer(0.0005, 0.01));  // by less than the sine
}

TEST(FeatureSurroundings, OfARidgeLetItHoldWhatIsBeforeIt) {
  const Roof ridge(1.0);  // normals from 45 degrees to the left to 45 to the right
  EXPECT_FALSE(ridge.left_goes_nearer(0.0, 0.01));
  EXPECT_FALSE(ridge.left_goes_nearer(0.009, 0.01));
  EXPECT_TRUE(ridge.left_goes_nearer(0.02, 0.01));  // before the other facet
}

TEST(FeatureSurroundings, InSpaceAreFacetsBesideAnEdgeAndEdgesFromANode) {
  // four triangles around the node 4 in the middle of a square, lowered at its corners
  for (const double down : {0.0, 1.0}) {
    SCOPED_TRACE(down);
    const std::vector<Eigen::Vector3d> points{
        {-1, -1, -down}, {1, -1, -down}, {1, 1, -down}, {-1, 1, -down}, {0, 0, 0}};
    Skin skin;
    skin.facets = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    skin.edges = {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 4}, {2, 3}, {2, 4}, {3, 4}};
    skin.nodes = {0, 1, 2, 3, 4};
    skin.group = {0, 0, 0, 0, 0, 1};
    skin.groups = 2;
    const FeaturePair below{FeatureKind::node_facet, {-1, 0, 1, 4}};
    // beside the edge from 1 to 4, on the flat side beyond it, and beyond the node 4
    const bool flat = down == 0.0;
    const Eigen::Vector3d beside =
        flat ? Eigen::Vector3d(0.52, -0.48, 0.02) : Eigen::Vector3d(0.51, -0.51, -0.48);
    EXPECT_EQ(goes_nearer(skin, points, below, beside), flat);
    EXPECT_EQ(goes_nearer(skin, points, below, {0.0, 0.01, 0.02}), flat);
    EXPECT_FALSE(goes_nearer(skin, points, below, {0.0, -0.5, 0.1}));
  }
}

}  // namespace
}  // namespace abut::surface_feature_surroundings_tests
