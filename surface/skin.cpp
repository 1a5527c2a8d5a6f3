#include "surface/skin.hpp"

#include <algorithm>

#include "base/assert.hpp"
#include "base/one_each.hpp"

namespace abut {
namespace {

void add_facets(Skin& skin, const PosedSurface& surface, std::int32_t first_point) {
  const auto point = [first_point](std::int32_t node) { return first_point + node; };
  for (int f = 0; f < surface.facet_count(); ++f) {
    const std::span<const std::int32_t> n = surface.nodes(f);
    if (skin.dim == 2) {
      skin.facets.push_back({point(n[0]), point(n[1]), -1});
      continue;
    }
    skin.facets.push_back({point(n[0]), point(n[1]), point(n[2])});
    if (n.size() == 4) skin.facets.push_back({point(n[0]), point(n[2]), point(n[3])});
  }
}

}  // namespace

Skin skin_of(std::span<const PosedSurface> surfaces) {
  Skin skin;
  skin.dim = surfaces.empty() ? 3 : surfaces.front().dim;
  skin.groups = static_cast<int>(surfaces.size());
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    ABUT_ASSERT(surfaces[s].dim == skin.dim);
    add_facets(skin, surfaces[s], skin.point_count());
    skin.group.insert(skin.group.end(), index(surfaces[s].node_count()),
                      static_cast<std::int32_t>(s));
  }
  const int corners = skin.facet_points();
  for (const std::array<std::int32_t, 3>& facet : skin.facets) {
    for (int i = 0; i < corners; ++i) {
      skin.nodes.push_back(facet[i]);
      if (skin.dim == 2) continue;
      const std::int32_t a = facet[i], b = facet[(i + 1) % 3];
      skin.edges.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  keep_one_each(skin.nodes);
  keep_one_each(skin.edges);
  return skin;
}

}  // namespace abut
