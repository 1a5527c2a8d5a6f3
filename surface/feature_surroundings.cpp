#include "surface/feature_surroundings.hpp"

#include <algorithm>

#include "base/index.hpp"
#include "base/one_each.hpp"

namespace abut {

namespace {
constexpr double no_weight = 1.0e-7;  // a point that takes less has no part in the closest one
}

void FeatureSurroundings::Lists::add(const std::vector<std::int32_t>& list) {
  numbers.insert(numbers.end(), list.begin(), list.end());
  offsets.push_back(static_cast<std::int32_t>(numbers.size()));
}

FeatureSurroundings::FeatureSurroundings(const Skin& skin) : skin_(skin) {
  std::vector<std::vector<std::int32_t>> around(index(skin.point_count())),
      facets(index(skin.point_count())), beside(skin.edges.size());
  const auto corners = index(skin.facet_points());
  for (std::size_t f = 0; f < skin.facets.size(); ++f) {
    const std::array<std::int32_t, 3>& facet = skin.facets[f];
    for (std::size_t i = 0; i < corners; ++i) {
      facets[index(facet[i])].push_back(static_cast<std::int32_t>(f));
      for (std::size_t j = 0; j < corners; ++j)
        if (j != i) around[index(facet[i])].push_back(facet[j]);
      if (corners == 2) continue;
      const std::int32_t a = facet[i], b = facet[(i + 1) % 3];
      const std::array<std::int32_t, 2> edge = {std::min(a, b), std::max(a, b)};
      const auto at = std::ranges::lower_bound(skin.edges, edge) - skin.edges.begin();
      beside[index(at)].push_back(facet[(i + 2) % 3]);
    }
  }
  for (std::vector<std::int32_t>& list : around) {
    keep_one_each(list);
    around_.add(list);
  }
  for (const std::vector<std::int32_t>& list : facets) facets_.add(list);
  for (const std::vector<std::int32_t>& list : beside) beside_.add(list);
}

std::vector<std::int32_t> FeatureSurroundings::facets_at(const FeaturePair& pair, int side) const {
  std::vector<std::int32_t> facets;
  const int first = side == 0 ? 0 : pair.first_side(), end = side == 0 ? pair.first_side() : 4;
  for (int i = first; i < end; ++i) {
    if (pair.points[index(i)] < 0) continue;
    const std::span<const std::int32_t> here = facets_.of(index(pair.points[index(i)]));
    facets.insert(facets.end(), here.begin(), here.end());
  }
  keep_one_each(facets);
  return facets;
}

void FeatureSurroundings::visit_around(
    const FeaturePair& pair, const std::function<void(const FeaturePair&)>& visit) const {
  const auto corners = index(skin_.facet_points());
  const std::vector<std::int32_t> ones = facets_at(pair, 0), others = facets_at(pair, 1);
  for (const std::int32_t one : ones) {
    for (const std::int32_t other : others) {
      const auto& a = skin_.facets[index(one)];
      const auto& b = skin_.facets[index(other)];
      for (std::size_t i = 0; i < corners; ++i) {
        visit({FeatureKind::node_facet, {a[i], b[0], b[1], b[2]}});
        visit({FeatureKind::node_facet, {b[i], a[0], a[1], a[2]}});
        if (corners == 2) continue;
        for (std::size_t j = 0; j < corners; ++j)
          visit({FeatureKind::edge_edge, {a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]}});
      }
    }
  }
}

std::span<const std::int32_t> FeatureSurroundings::beside(std::int32_t one,
                                                          std::int32_t other) const {
  const std::array<std::int32_t, 2> edge = {std::min(one, other), std::max(one, other)};
  const auto at = std::ranges::lower_bound(skin_.edges, edge) - skin_.edges.begin();
  return beside_.of(index(at));
}

/// From a node along its edges, from an edge into its facets; inside of a facet there is nothing.
bool FeatureSurroundings::goes_nearer(const FeaturePair& pair, const std::array<double, 4>& weights,
                                      int side, const Eigen::Vector3d& way, double sine,
                                      const PartOfWay& places) const {
  const int first = side == 0 ? 0 : pair.first_side(), end = side == 0 ? pair.first_side() : 4;
  std::array<std::int32_t, 3> held{};
  int count = 0;
  for (int i = first; i < end; ++i)
    if (pair.points[index(i)] >= 0 && std::abs(weights[index(i)]) > no_weight)
      held[index(count++)] = pair.points[index(i)];
  const bool on_node = count == 1, on_edge = count == 2 && skin_.dim == 3;
  if (!on_node && !on_edge) return false;
  const Eigen::Vector3d nearer = side == 0 ? Eigen::Vector3d(-way) : way;
  const Eigen::Vector3d begin = places[held[0]];
  const Eigen::Vector3d along =
      on_edge ? Eigen::Vector3d((places[held[1]] - begin).normalized()) : Eigen::Vector3d::Zero();
  const std::span<const std::int32_t> others =
      on_edge ? beside(held[0], held[1]) : around_.of(index(held[0]));
  return std::ranges::any_of(others, [&](std::int32_t other) {
    Eigen::Vector3d off = places[other] - begin;
    off -= along.dot(off) * along;
    return nearer.dot(off) > sine * off.norm();
  });
}

}  // namespace abut
