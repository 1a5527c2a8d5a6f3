#pragma once

#include <span>
#include <vector>

#include "subdomain_solver/contact/contact_fields.hpp"
#include "surface/boxes.hpp"

namespace abut {

/// Watches whether a body folds onto itself: contact within a port is not solved for, so facets of
/// it that meet pass through each other.
class SelfCrossings {
 public:
  explicit SelfCrossings(const std::vector<TouchedSurface>& surfaces);

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
