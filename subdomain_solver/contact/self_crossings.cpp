#include "subdomain_solver/contact/self_crossings.hpp"

#include "surface/crossings.hpp"

namespace abut {

SelfCrossings::SelfCrossings(const std::vector<PortSurface>& surfaces) {
  for (const PortSurface& s : surfaces) {
    const PortGeometry& g = *s.geometry;
    Watched& port = ports_.emplace_back(Watched{s.first, &g, {}});
    build(port.tree, {g.dim, g.points, g.facets, g.offsets}, 0.0);
  }
}

int SelfCrossings::count(std::span<const double> places) {
  int sum = 0;
  for (Watched& port : ports_) {
    const PortGeometry& g = *port.geometry;
    pose_ = g.points;
    for (std::size_t v = 0; v < pose_.size(); ++v) pose_[v] += places[port.first + v];
    const PosedSurface posed{g.dim, pose_, g.facets, g.offsets};
    refit(port.tree, posed, 0.0);
    sum += crossings(posed, port.tree, pairs_).count;
  }
  return sum;
}

}  // namespace abut
