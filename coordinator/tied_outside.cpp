#include "coordinator/tied_outside.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "base/index.hpp"
#include "surface/inside.hpp"

namespace abut {

namespace {

/// Adds the facets of a port; nodes at one place are one.
void add_port(const PortGeometry& port, std::map<std::vector<double>, std::int32_t>& known,
              PortGeometry& all) {
  const std::size_t dim = index(port.dim);
  std::vector<std::int32_t> number;
  for (std::size_t v = 0; v < port.points.size(); v += dim) {
    const auto at = port.points.begin() + static_cast<std::ptrdiff_t>(v);
    const auto [entry, fresh] =
        known.emplace(std::vector<double>(at, at + static_cast<std::ptrdiff_t>(dim)),
                      static_cast<std::int32_t>(all.points.size() / dim));
    if (fresh) all.points.insert(all.points.end(), at, at + static_cast<std::ptrdiff_t>(dim));
    number.push_back(entry->second);
  }
  for (std::size_t f = 0; f + 1 < port.offsets.size(); ++f) {
    for (std::int32_t k = port.offsets[f]; k < port.offsets[f + 1]; ++k)
      all.facets.push_back(number[index(port.facets[index(k)])]);
    all.offsets.push_back(static_cast<std::int32_t>(all.facets.size()));
  }
}

}  // namespace

std::optional<PortGeometry> tied_outside(const Scene& scene, const Side& side,
                                         const Bodies& bodies) {
  const Description& body = bodies.describe(side.body);
  const Port& own = body.ports[index(side.port)];
  if (own.geometry.dim == 1 || is_closed(posed(own.geometry))) return std::nullopt;
  PortGeometry all;
  all.dim = own.geometry.dim;
  all.spacing = own.geometry.spacing;
  all.offsets = {0};
  std::map<std::vector<double>, std::int32_t> known;
  add_port(own.geometry, known, all);
  for (const Port& port : body.ports) {
    const bool tied = std::ranges::any_of(scene.interfaces, [&](const auto& entry) {
      return entry.second.tied &&
             std::ranges::find(entry.second.sides, body.name + '.' + port.name) !=
                 entry.second.sides.end();
    });
    if (tied && port.name != own.name) add_port(port.geometry, known, all);
  }
  if (!is_closed(posed(all))) return std::nullopt;
  return all;
}

}  // namespace abut
