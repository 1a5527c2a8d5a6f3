#include "subdomain_solver/fe/facet_index.hpp"

#include <algorithm>
#include <cstddef>

#include "base/assert.hpp"
#include "base/index.hpp"

namespace abut {
namespace {

std::size_t largest(const std::array<std::int32_t, 4>& corners) { return index(corners[3]); }

}  // namespace

FacetIndex::Corners FacetIndex::sorted(std::span<const std::int32_t> corners) {
  ABUT_ASSERT(!corners.empty() && corners.size() <= 4);
  Corners key = {-1, -1, -1, -1};
  std::copy(corners.begin(), corners.end(), key.begin());
  std::sort(key.begin(), key.end());
  return key;
}

FacetIndex::FacetIndex(const Mesh& mesh) {
  std::array<std::int32_t, 4> nodes{};
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    const CellBlock& block = mesh.blocks[b];
    const Element& element = *block.element;
    const auto corners = index(element_named(element.facet_name).corner_count());
    for (std::int32_t cell = 0; cell < block.count(); ++cell) {
      const std::int32_t* own = &block.nodes[index(cell) * index(element.nodes)];
      for (std::size_t f = 0; f < element.facets.size(); ++f) {
        for (std::size_t a = 0; a < corners; ++a) nodes[a] = own[element.facets[f][a]];
        facets_.push_back({static_cast<std::int32_t>(b), cell, static_cast<std::int32_t>(f)});
        corners_.push_back(sorted(std::span(nodes).first(corners)));
      }
    }
  }
  begin_.assign(index(mesh.node_count()) + 1, 0);
  for (const Corners& key : corners_) ++begin_[largest(key) + 1];
  for (std::size_t n = 1; n < begin_.size(); ++n) begin_[n] += begin_[n - 1];
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  by_node_.resize(facets_.size());
  for (std::size_t f = 0; f < facets_.size(); ++f)
    by_node_[next[largest(corners_[f])]++] = static_cast<std::uint32_t>(f);
}

std::span<const std::uint32_t> FacetIndex::bucket(const Corners& corners) const {
  const std::size_t node = largest(corners);
  if (node + 1 >= begin_.size()) return {};
  return std::span(by_node_).subspan(begin_[node], begin_[node + 1] - begin_[node]);
}

std::vector<Facet> FacetIndex::boundary() const {
  std::vector<Facet> alone;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    int count = 0;
    for (std::uint32_t other : bucket(corners_[f])) count += corners_[other] == corners_[f];
    if (count == 1) alone.push_back(facets_[f]);
  }
  return alone;
}

std::vector<Facet> FacetIndex::find(std::span<const std::int32_t> corners) const {
  const Corners key = sorted(corners);
  std::vector<Facet> found;
  for (std::uint32_t f : bucket(key))
    if (corners_[f] == key) found.push_back(facets_[f]);
  return found;
}

}  // namespace abut
