#pragma once

#include <cstddef>
#include <vector>

#include "contract/subdomain.hpp"

namespace abut {

/// Places of a facet's nodes [m], (nodes, dim), in an order of their own: what tells it from other
/// facets of its body, by whatever port it is seen.
std::vector<double> places_of_facet(const PortGeometry& surface, std::size_t facet);

/// By port of a body: whether all of its facets are among the more facets of another port of it, as
/// those of a side that is tied or looked at are among those of the boundary. Where everything may
/// touch everything the other port touches for it.
std::vector<bool> parts_of_others(const Description& body);

}  // namespace abut
