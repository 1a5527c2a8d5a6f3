#include "coordinator/coupling/twin_nodes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include <Eigen/Core>

namespace abut {

namespace {

constexpr double same_place = 1.0e-6;  // of the shortest edge

using Facet = std::array<std::int32_t, 4>;  // sorted, -1 in front where there are fewer nodes

double shortest_edge(const PosedSurface& surface) {
  double least = std::numeric_limits<double>::infinity();
  for (int f = 0; f < surface.facet_count(); ++f) {
    const Corners c = corners(surface, f);
    for (int a = 0; a < c.count; ++a)
      least = std::min(least, (c.x[a] - c.x[(a + 1) % c.count]).norm());
  }
  return least;
}

/// Nodes of a surface in order along a direction in which nodes of lattices differ.
class TwinPlaces {
 public:
  explicit TwinPlaces(const PosedSurface& surface) : surface_(surface) {
    for (std::int32_t node = 0; node < surface.node_count(); ++node)
      nodes_.emplace_back(along(surface.point(node)), node);
    std::ranges::sort(nodes_);
  }

  /// The nearest node within reach; -1: there is none.
  std::int32_t at(const Eigen::Vector3d& x, double reach) const {
    std::int32_t found = -1;
    const double s = along(x), far = 2.0 * reach;  // the direction is shorter than 2
    for (auto it = std::ranges::lower_bound(nodes_, std::pair(s - far, std::int32_t{-1}));
         it != nodes_.end() && it->first <= s + far; ++it) {
      const double distance = (surface_.point(it->second) - x).norm();
      if (distance > reach) continue;
      found = it->second;
      reach = distance;
    }
    return found;
  }

 private:
  static double along(const Eigen::Vector3d& x) {
    return x.x() + 0.7320508 * x.y() + 0.4142136 * x.z();
  }
  const PosedSurface& surface_;
  std::vector<std::pair<double, std::int32_t>> nodes_;
};

template <class NodeOf>
Facet facet_of(const PosedSurface& surface, int facet, NodeOf node_of) {
  Facet sorted = {-1, -1, -1, -1};
  std::size_t place = 0;
  for (std::int32_t node : surface.nodes(facet)) sorted[place++] = node_of(node);
  std::ranges::sort(sorted);
  return sorted;
}

}  // namespace

std::vector<std::int32_t> twin_nodes(const PosedSurface& one, const PosedSurface& other) {
  const double reach = same_place * std::min(shortest_edge(one), shortest_edge(other));
  const TwinPlaces places(other);
  std::vector<std::int32_t> twins;
  for (std::int32_t node = 0; node < one.node_count(); ++node) {
    twins.push_back(places.at(one.point(node), reach));
    if (twins.back() < 0) return {};
  }
  return facets_meet(one, other, twins) ? twins : std::vector<std::int32_t>();
}

bool facets_meet(const PosedSurface& one, const PosedSurface& other,
                 const std::vector<std::int32_t>& twins) {
  std::set<Facet> facets;
  for (int f = 0; f < other.facet_count(); ++f)
    facets.insert(facet_of(other, f, [](std::int32_t node) { return node; }));
  for (int f = 0; f < one.facet_count(); ++f) {
    const auto twin = [&twins](std::int32_t node) { return twins[node]; };
    if (!facets.contains(facet_of(one, f, twin))) return false;
  }
  return true;
}

}  // namespace abut
