#include "contract/whole_facets.hpp"

#include <numeric>

#include "base/index.hpp"

namespace abut {

namespace {

using Parts = std::vector<std::vector<int>>;

/// Nodes of a facet that has so many straight parts, of which the first has so many corners.
std::size_t nodes_of(std::int32_t parts, std::size_t corners) {
  if (parts == 1) return corners;
  return parts == 2 ? 3 : parts == 4 ? 6 : 8;
}

std::size_t size_of(const PortGeometry& surface, std::size_t facet) {
  return index(surface.offsets[facet + 1] - surface.offsets[facet]);
}

std::int32_t node_of(const PortGeometry& surface, std::size_t facet, std::size_t corner) {
  return surface.facets[index(surface.offsets[facet]) + corner];
}

/// Its nodes from straight facets, the first of which is `first`.
std::vector<std::int32_t> joined(const PortGeometry& surface, std::size_t first, const Parts& parts,
                                 std::size_t nodes) {
  std::vector<std::int32_t> all(nodes);
  for (std::size_t k = 0; k < parts.size(); ++k)
    for (std::size_t i = 0; i < parts[k].size(); ++i)
      all[parts[k][i]] = node_of(surface, first + k, i);
  return all;
}

bool has_sizes(const PortGeometry& surface, std::size_t first, const Parts& parts) {
  for (std::size_t k = 0; k < parts.size(); ++k)
    if (size_of(surface, first + k) != parts[k].size()) return false;
  return true;
}

bool is_shown(const PortGeometry& surface, std::size_t first, const Parts& parts,
              const std::vector<std::int32_t>& nodes) {
  for (std::size_t k = 0; k < parts.size(); ++k)
    for (std::size_t i = 0; i < parts[k].size(); ++i)
      if (node_of(surface, first + k, i) != nodes[parts[k][i]]) return false;
  return true;
}

}  // namespace

const Parts& straight_parts(int dim, std::size_t nodes) {
  static const Parts segment = {{0, 1}}, bent = {{0, 2}, {2, 1}};
  static const Parts triangle = {{0, 1, 2}}, quadrilateral = {{0, 1, 2, 3}};
  static const Parts tri6 = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
  static const Parts quad8 = {{0, 4, 7}, {1, 5, 4}, {2, 6, 5}, {3, 7, 6}, {4, 5, 6, 7}};
  if (dim == 2) return nodes == 2 ? segment : bent;
  if (nodes == 3) return triangle;
  if (nodes == 4) return quadrilateral;
  return nodes == 6 ? tri6 : quad8;
}

WholeFacets whole_facets(const PortGeometry& surface) {
  WholeFacets whole;
  if (surface.parts.empty()) {
    whole.nodes = surface.facets;
    whole.offsets = surface.offsets;
    whole.of.resize(surface.offsets.size() - 1);
    std::iota(whole.of.begin(), whole.of.end(), 0);
    return whole;
  }
  std::size_t first = 0;
  std::int32_t facet = 0;
  for (const std::int32_t count : surface.parts) {
    const std::size_t nodes = nodes_of(count, size_of(surface, first));
    const std::vector<std::int32_t> all =
        joined(surface, first, straight_parts(surface.dim, nodes), nodes);
    whole.nodes.insert(whole.nodes.end(), all.begin(), all.end());
    whole.offsets.push_back(static_cast<std::int32_t>(whole.nodes.size()));
    whole.of.insert(whole.of.end(), index(count), facet++);
    first += index(count);
  }
  return whole;
}

std::string unsound_parts(const PortGeometry& surface) {
  if (surface.parts.empty()) return "";
  std::size_t first = 0;
  const std::size_t facets = surface.offsets.empty() ? 0 : surface.offsets.size() - 1;
  for (const std::int32_t count : surface.parts) {
    const bool known = count == 1 || (surface.dim == 2 && count == 2) ||
                       (surface.dim == 3 && (count == 4 || count == 5));
    if (!known) return "names a facet of " + std::to_string(count) + " parts";
    if (first + index(count) > facets) return "names more than there are";
    const std::size_t nodes = nodes_of(count, size_of(surface, first));
    const Parts& parts = straight_parts(surface.dim, nodes);
    if (parts.size() != index(count) || !has_sizes(surface, first, parts))
      return "does not fit the size of facet " + std::to_string(first);
    if (!is_shown(surface, first, parts, joined(surface, first, parts, nodes)))
      return "does not fit the nodes of facet " + std::to_string(first);
    first += index(count);
  }
  if (first != facets) return "names " + std::to_string(first) + " of " + std::to_string(facets);
  return "";
}

}  // namespace abut
