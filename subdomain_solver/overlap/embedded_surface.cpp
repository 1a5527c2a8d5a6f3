#include "subdomain_solver/overlap/embedded_surface.hpp"


namespace abut {

void add_to(const EmbeddedSurface& inside, PortGeometry& port) {
  if (inside.count() == 0) return;
  const std::int32_t own = port.count();
  const std::int32_t facets = static_cast<std::int32_t>(port.facets.size());
  port.embedded = inside.count();
  port.points.insert(port.points.end(), inside.points.begin(), inside.points.end());
  port.normals.resize(port.points.size(), 0.0);
  for (const std::int32_t node : inside.facets) port.facets.push_back(own + node);
  for (std::size_t f = 1; f < inside.offsets.size(); ++f)
    port.offsets.push_back(facets + inside.offsets[f]);
}

}  // namespace abut
