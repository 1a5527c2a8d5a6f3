#include "surface/skin_trees.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/assert.hpp"
#include "surface/feature_distance.hpp"

namespace abut {
namespace {

using Points = std::span<const Eigen::Vector3d>;

Box box_of(std::span<const std::int32_t> feature, Points from, Points to) {
  Eigen::Vector3d low = from[feature[0]], high = low;
  for (const std::int32_t point : feature) {
    low = low.cwiseMin(from[point]).cwiseMin(to[point]);
    high = high.cwiseMax(from[point]).cwiseMax(to[point]);
  }
  return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

/// Where a group's features begin among all of a kind, by the group of each one's first point.
template <class GroupOf>
std::vector<std::int32_t> begins(int groups, std::size_t count, const GroupOf& group_of) {
  std::vector<std::int32_t> begin(index(groups) + 1, 0);
  for (std::size_t i = 0; i < count; ++i) ++begin[index(group_of(i)) + 1];
  for (std::size_t g = 1; g < begin.size(); ++g) begin[g] += begin[g - 1];
  return begin;
}

double box_distance(const Box& box, const Eigen::Vector3d& x) {
  double square = 0.0;
  for (int d = 0; d < 3; ++d) {
    const double apart = std::max({0.0, box.low[d] - x[d], x[d] - box.high[d]});
    square += apart * apart;
  }
  return std::sqrt(square);
}

}  // namespace

SkinTrees::SkinTrees(const Skin& skin, Points points) : skin_(skin) {
  const auto group_of = [&skin](std::int32_t point) { return skin.group[index(point)]; };
  forests_[nodes].begin = begins(skin.groups, skin.nodes.size(), [&skin, group_of](std::size_t i) {
    return group_of(skin.nodes[i]);
  });
  forests_[edges].begin = begins(skin.groups, skin.edges.size(), [&skin, group_of](std::size_t i) {
    return group_of(skin.edges[i][0]);
  });
  forests_[facets].begin =
      begins(skin.groups, skin.facets.size(),
             [&skin, group_of](std::size_t i) { return group_of(skin.facets[i][0]); });
  set_boxes(points, points);
  for (Forest& forest : forests_) {
    forest.trees.resize(index(skin.groups));
    for (std::size_t g = 0; g < forest.trees.size(); ++g)
      build(forest.trees[g],
            std::span(forest.boxes)
                .subspan(index(forest.begin[g]), index(forest.begin[g + 1] - forest.begin[g])));
  }
}

void SkinTrees::set_boxes(Points from, Points to) {
  ABUT_ASSERT(from.size() == skin_.group.size() && to.size() == from.size());
  std::vector<Box>& of_nodes = forests_[nodes].boxes;
  of_nodes.resize(skin_.nodes.size());
  for (std::size_t i = 0; i < of_nodes.size(); ++i)
    of_nodes[i] = box_of(std::span(&skin_.nodes[i], 1), from, to);
  std::vector<Box>& of_edges = forests_[edges].boxes;
  of_edges.resize(skin_.edges.size());
  for (std::size_t i = 0; i < of_edges.size(); ++i) of_edges[i] = box_of(skin_.edges[i], from, to);
  std::vector<Box>& of_facets = forests_[facets].boxes;
  of_facets.resize(skin_.facets.size());
  const std::size_t corners = index(skin_.facet_points());
  for (std::size_t i = 0; i < of_facets.size(); ++i)
    of_facets[i] = box_of(std::span(skin_.facets[i]).first(corners), from, to);
}

void SkinTrees::refit(Points from, Points to) {
  set_boxes(from, to);
  for (Forest& forest : forests_) {
    for (std::size_t g = 0; g < forest.trees.size(); ++g)
      abut::refit(forest.trees[g], std::span(forest.boxes)
                                       .subspan(index(forest.begin[g]),
                                                index(forest.begin[g + 1] - forest.begin[g])));
  }
}

std::int32_t SkinTrees::closest_facet(int group, Points points, const Eigen::Vector3d& x,
                                      double reach) const {
  const BoxTree& tree = forests_[facets].trees[index(group)];
  const std::int32_t first = forests_[facets].begin[index(group)];
  if (tree.empty()) return -1;
  std::int32_t closest = -1;
  double best = reach;
  // A box that holds the closest facet may seem a little farther off than that.
  constexpr double rounding = 8.0 * std::numeric_limits<double>::epsilon();
  const double size = x.cwiseAbs().maxCoeff();
  // Each step goes one level down and leaves one node behind: 31 levels, as in box_pairs.hpp.
  std::array<std::int32_t, 40> stack;
  int count = 0;
  stack[count++] = 0;
  while (count > 0) {
    const std::int32_t node = stack[--count];
    if (box_distance(tree.boxes[node], x) > best + rounding * (size + best)) continue;
    if (tree.is_leaf(node)) {
      const std::int32_t facet = first + tree.facet(node);
      const auto& p = skin_.facets[index(facet)];
      const double distance =
          feature_distance(FeatureKind::node_facet, skin_.dim,
                           {x, points[p[0]], points[p[1]], points[p[2] < 0 ? p[1] : p[2]]})
              .distance;
      if (distance > best || (distance == best && closest >= 0 && facet > closest)) continue;
      best = distance;
      closest = facet;
      continue;
    }
    const std::int32_t one = node + 1, other = tree.second[node];
    const bool one_is_nearer =
        box_distance(tree.boxes[one], x) <= box_distance(tree.boxes[other], x);
    stack[count++] = one_is_nearer ? other : one;
    stack[count++] = one_is_nearer ? one : other;
  }
  return closest;
}

}  // namespace abut
