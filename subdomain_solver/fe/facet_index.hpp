#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// All facets of all cells, found by their corner nodes in any order.
class FacetIndex {
 public:
  explicit FacetIndex(const Mesh& mesh);

  /// Facets that belong to one cell only, in the order of the cells.
  std::vector<Facet> boundary() const;
  /// The facets with these corners: none, one on the boundary, two inside.
  std::vector<Facet> find(std::span<const std::int32_t> corners) const;

 private:
  using Corners = std::array<std::int32_t, 4>;  // sorted, -1 in front where there are fewer

  static Corners sorted(std::span<const std::int32_t> corners);
  std::span<const std::uint32_t> bucket(const Corners& corners) const;

  std::vector<Facet> facets_;
  std::vector<Corners> corners_;        // (facets)
  std::vector<std::uint32_t> begin_;    // (nodes + 1) into by_node_, by the largest corner
  std::vector<std::uint32_t> by_node_;  // facets
};

}  // namespace abut
