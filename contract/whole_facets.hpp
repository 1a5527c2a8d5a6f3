#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "contract/port.hpp"

namespace abut {

/// The straight facets that show a facet of `nodes` nodes of a body in `dim` dimensions, each as
/// places among its nodes: corners first, then what lies between them, edge by edge. Those of
/// second order (3 nodes in the plane, 6 and 8 in space) are divided at their nodes.
const std::vector<std::vector<int>>& straight_parts(int dim, std::size_t nodes);

/// The facets of a surface as its elements have them.
struct WholeFacets {
  std::vector<std::int32_t> nodes, offsets = {0};  // one facet after the other
  std::vector<std::int32_t> of;                    // (straight facets) the whole one of each
};

/// Those that PortGeometry::parts tells of, which fits.
WholeFacets whole_facets(const PortGeometry& surface);

/// What is wrong with PortGeometry::parts, in words; empty: nothing. Facets and offsets are sound.
std::string unsound_parts(const PortGeometry& surface);

}  // namespace abut
