// Goal: the tree finds exactly the pairs of facets whose boxes overlap, also after its boxes were
// renewed for another pose, and always in the same order.
// Oracle: every pair tested.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/surfaces.hpp"

namespace abut::surface_boxes_tests {
namespace {

/// Facets strewn about a cube (or a square), each with its own nodes.
SurfaceMesh strewn(int count, int dim, double size, DrawNumbers& draw) {
  SurfaceMesh mesh;
  mesh.dim = dim;
  for (int f = 0; f < count; ++f) {
    const int corners = dim == 2 ? 2 : 3 + f % 2;
    const std::vector<double> middle = draw.many(3, 0.0, 1.0);
    std::vector<std::int32_t> nodes;
    for (int i = 0; i < corners; ++i) {
      nodes.push_back(mesh.nodes());
      for (int d = 0; d < dim; ++d) mesh.points.push_back(middle[d] + draw(-size, size));
    }
    mesh.add_facet(nodes, false);
  }
  return mesh;
}

std::vector<FacetPair> every_pair(const std::vector<Box>& a, const std::vector<Box>& b) {
  std::vector<FacetPair> pairs;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j)
      if (overlap(a[i], b[j]))
        pairs.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)});
  return pairs;
}

std::vector<Box> boxes_of(const SurfaceMesh& mesh, double margin) {
  std::vector<Box> boxes;
  for (int f = 0; f < mesh.pose().facet_count(); ++f)
    boxes.push_back(facet_box(mesh.pose(), f, margin));
  return boxes;
}

class Trees : public testing::TestWithParam<int> {};

TEST_P(Trees, FindEveryPairAndNoOtherBeforeAndAfterARefit) {
  DrawNumbers draw(5);
  for (const int count : {1, 2, 3, 17, 400}) {
    SurfaceMesh a = strewn(count, GetParam(), 0.05, draw);
    SurfaceMesh b = strewn(count + 5, GetParam(), 0.05, draw);
    BoxTree ta, tb;
    build(ta, a.pose(), 0.01);
    build(tb, b.pose(), 0.0);
    std::vector<FacetPair> pairs{{7, 7}};
    overlapping_pairs(ta, tb, pairs);
    EXPECT_EQ(pairs, every_pair(boxes_of(a, 0.01), boxes_of(b, 0.0)));
    const std::vector<std::int32_t> structure = ta.second;
    const Box* memory = ta.boxes.data();
    for (double& x : a.points) x += draw(-0.2, 0.2);
    refit(ta, a.pose(), 0.02);
    overlapping_pairs(ta, tb, pairs);
    EXPECT_EQ(pairs, every_pair(boxes_of(a, 0.02), boxes_of(b, 0.0)));
    EXPECT_EQ(ta.second, structure);
    EXPECT_EQ(ta.boxes.data(), memory) << "a refit allocates";
  }
}

TEST_P(Trees, SweptBoxesHoldTheFacetAllTheWay) {
  DrawNumbers draw(6);
  const SurfaceMesh from = strewn(60, GetParam(), 0.05, draw);
  std::vector<double> to = from.points, between = from.points;
  for (double& x : to) x += draw(-0.3, 0.3);
  BoxTree tree;
  build(tree, from.pose(), 0.0);
  refit(tree, from.pose(), from.pose(to), 0.0);
  for (const double part : {0.0, 0.3, 1.0}) {
    for (std::size_t i = 0; i < to.size(); ++i)
      between[i] = (1.0 - part) * from.points[i] + part * to[i];
    for (int node = 0; node < static_cast<int>(tree.boxes.size()); ++node) {
      if (!tree.is_leaf(node)) continue;
      const Box inner = facet_box(from.pose(between), tree.facet(node), 0.0);
      for (int d = 0; d < 3; ++d) {
        // a mean of two numbers may round to beyond them
        EXPECT_LE(tree.boxes[node].low[d], inner.low[d] + 1e-15);
        EXPECT_GE(tree.boxes[node].high[d], inner.high[d] - 1e-15);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(InPlaneAndSpace, Trees, testing::Values(2, 3));

TEST(Tree, IsShallowHoweverFacetsAreCrowded) {
  // all centres in one point: halves in numbers, not in space
  SurfaceMesh mesh;
  for (int f = 0; f < 1000; ++f) {
    const std::int32_t at = mesh.nodes();
    for (const double x : {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0}) mesh.points.push_back(x);
    mesh.add_facet({at, at + 1, at + 2}, false);
  }
  BoxTree tree;
  build(tree, mesh.pose(), 0.0);
  std::vector<int> depth(tree.boxes.size(), 0);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (tree.is_leaf(static_cast<int>(i))) continue;
    depth[i + 1] = depth[tree.second[i]] = depth[i] + 1;
  }
  EXPECT_EQ(*std::max_element(depth.begin(), depth.end()), 10);  // 2^10 >= 1000
}

TEST(Tree, OfNoFacetsMeetsNothing) {
  const SurfaceMesh none,
      one = grid(
          1, 1, [](double u, double v) { return Eigen::Vector3d(u, v, 0); }, false, false);
  BoxTree a, b;
  build(a, none.pose(), 1.0);
  build(b, one.pose(), 1.0);
  std::vector<FacetPair> pairs{{1, 1}};
  overlapping_pairs(a, b, pairs);
  EXPECT_TRUE(pairs.empty());
  overlapping_pairs(b, a, pairs);
  EXPECT_TRUE(pairs.empty());
}

}  // namespace
}  // namespace abut::surface_boxes_tests
