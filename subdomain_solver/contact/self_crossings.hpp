#pragma once

#include <span>
#include <vector>

#include "subdomain_solver/contact/surface_contact.hpp"
#include "surface/boxes.hpp"

namespace abut {

/// Watches whether facets of a port pass through each other: a body's own scheme knows of no
/// contact with itself, which the passive way keeps where the scene lets it (contact.self).
class SelfCrossings {
 public:
  explicit SelfCrossings(const std::vector<PortSurface>& surfaces);

  /// Pairs of facets of a port that do now. `places`: [m] (port values) displacements.
  int count(std::span<const double> places);

 private:
  struct Watched {
    std::size_t first;
    const PortGeometry* geometry;
    BoxTree tree;
  };

  std::vector<Watched> ports_;
  std::vector<double> pose_;  // [m] (points, dim) of a port
  std::vector<FacetPair> pairs_;
};

}  // namespace abut
