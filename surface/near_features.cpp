#include "surface/near_features.hpp"

#include <algorithm>

namespace abut {
namespace {

/// Collects the pairs that count.
class Collector {
 public:
  Collector(const Skin& skin, const FeatureChoice& choice, std::vector<FeaturePair>& pairs)
      : skin_(skin), choice_(choice), pairs_(pairs) {}

  void add_node_and_facet(std::int32_t node, std::int32_t facet) {
    const auto& f = skin_.facets[facet];
    const std::int32_t p = skin_.nodes[node];
    if (f[0] != p && f[1] != p && f[2] != p) add({FeatureKind::node_facet, {p, f[0], f[1], f[2]}});
  }
  void add_edges(std::int32_t one, std::int32_t other) {
    const auto &a = skin_.edges[std::min(one, other)], &b = skin_.edges[std::max(one, other)];
    if (a[0] != b[0] && a[0] != b[1] && a[1] != b[0] && a[1] != b[1])
      add({FeatureKind::edge_edge, {a[0], a[1], b[0], b[1]}});
  }

 private:
  void add(const FeaturePair& pair) {
    const auto given = [this](std::int32_t p) { return p < 0 || choice_.is_prescribed(p); };
    if (!std::ranges::all_of(pair.points, given)) pairs_.push_back(pair);
  }

  const Skin& skin_;
  const FeatureChoice& choice_;
  std::vector<FeaturePair>& pairs_;
};

}  // namespace

void near_features(SkinTrees& trees, std::span<const Eigen::Vector3d> from,
                   std::span<const Eigen::Vector3d> to, double reach, const FeatureChoice& choice,
                   std::vector<FeaturePair>& pairs) {
  const Skin& skin = trees.skin();
  trees.refit(from, to);
  pairs.clear();
  Collector collector(skin, choice, pairs);
  const auto node_facet = [&collector](std::int32_t k, std::int32_t n) {
    collector.add_node_and_facet(k, n);
  };
  const auto edge_edge = [&collector](std::int32_t k, std::int32_t n) {
    collector.add_edges(k, n);
  };
  for (int g = 0; g < skin.groups; ++g) {
    for (int h = g; h < skin.groups; ++h) {
      if (!choice.allows(g, h, skin.groups)) continue;
      trees.visit(SkinTrees::nodes, g, SkinTrees::facets, h, reach, node_facet);
      if (h != g) trees.visit(SkinTrees::nodes, h, SkinTrees::facets, g, reach, node_facet);
      trees.visit(SkinTrees::edges, g, SkinTrees::edges, h, reach, edge_edge);
    }
  }
  std::ranges::sort(pairs);
}

}  // namespace abut
