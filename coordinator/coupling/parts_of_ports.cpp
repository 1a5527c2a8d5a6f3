#include "coordinator/coupling/parts_of_ports.hpp"

#include <algorithm>
#include <set>

#include "base/index.hpp"

namespace abut {

std::vector<double> places_of_facet(const PortGeometry& surface, std::size_t facet) {
  const std::size_t dim = index(surface.dim);
  std::vector<std::vector<double>> nodes;
  for (std::int32_t k = surface.offsets[facet]; k < surface.offsets[facet + 1]; ++k) {
    const auto at =
        surface.points.begin() + static_cast<std::ptrdiff_t>(index(surface.facets[k]) * dim);
    nodes.emplace_back(at, at + static_cast<std::ptrdiff_t>(dim));
  }
  std::ranges::sort(nodes);
  std::vector<double> all;
  for (const std::vector<double>& node : nodes) all.insert(all.end(), node.begin(), node.end());
  return all;
}

std::vector<bool> parts_of_others(const Description& body) {
  std::vector<bool> parts(body.ports.size(), false);
  if (body.ports.size() < 2) return parts;
  std::vector<std::set<std::vector<double>>> facets(body.ports.size());
  for (std::size_t p = 0; p < body.ports.size(); ++p) {
    const PortGeometry& surface = body.ports[p].geometry;
    for (std::size_t f = 0; f + 1 < surface.offsets.size(); ++f)
      facets[p].insert(places_of_facet(surface, f));
  }
  for (std::size_t p = 0; p < parts.size(); ++p)
    parts[p] = std::ranges::any_of(facets, [&part = facets[p]](const auto& whole) {
      return !part.empty() && part.size() < whole.size() && std::ranges::includes(whole, part);
    });
  return parts;
}

}  // namespace abut
