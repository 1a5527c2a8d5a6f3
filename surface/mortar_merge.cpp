#include "surface/mortar_merge.hpp"

#include <cmath>
#include <cstddef>

#include "base/index.hpp"

namespace abut {
namespace {

/// Weights that differ by less than this are equal, so that symmetric meshes merge alike however
/// they are turned or numbered: round-off never chooses.
constexpr double resolution = 1.0e-6;

}  // namespace

bool is_light(double weight, double full, double share) {
  return weight < (1.0 - resolution) * share * full;
}

void merged_rows(const PosedSurface& k, const MortarPieces& pieces, std::span<const double> weight,
                 std::span<const double> full, std::span<const double> gap, double share,
                 double level, MergeBuffers& buffers, std::vector<std::int32_t>& root) {
  const std::size_t count = index(k.node_count());
  buffers.rank.resize(count);
  root.resize(count);
  for (std::size_t j = 0; j < count; ++j) {
    root[j] = weight[j] > 0.0 ? static_cast<std::int32_t>(j) : -1;
    if (root[j] >= 0) buffers.rank[j] = std::llround(std::log(weight[j]) / resolution);
  }
  // a total order, so that rows that join rows that join rows come to an end
  const auto heavier = [&buffers](std::int32_t i, std::int32_t j) {
    return buffers.rank[i] > buffers.rank[j] || (buffers.rank[i] == buffers.rank[j] && i < j);
  };
  const double power = 1.0 / (k.dim - 1);
  const auto is_level = [&](std::int32_t i, std::int32_t j) {
    return std::abs(gap[i] - gap[j]) < level * std::pow(full[j], power);
  };
  for (const MortarFacet& facet : pieces.facets) {
    for (std::int32_t j : k.nodes(facet.facet)) {
      if (root[j] < 0 || !is_light(weight[j], full[j], share)) continue;
      for (std::int32_t i : k.nodes(facet.facet))
        if (root[i] >= 0 && heavier(i, root[j]) && is_level(i, j)) root[j] = i;
    }
  }
  for (std::size_t j = 0; j < count; ++j)
    while (root[j] >= 0 && root[root[j]] != root[j]) root[j] = root[root[j]];
}

}  // namespace abut
