#pragma once

#include <span>
#include <vector>

#include "contract/field.hpp"
#include "contract/port.hpp"

namespace abut {

/// From points and facets: normals of points, means of those of the facets around by their size;
/// the mean edge as spacing. Throws InputError for facets of no such points, or, where they enclose
/// a body, that look into it.
void complete_surface(PortGeometry& surface);

/// (n, 3) from (n, dim): zeros for axes that a body does not have.
std::vector<double> in_space(std::span<const double> values, int dim);

/// Points and facets of the surfaces of ports, to be drawn.
Grid surfaces_of(std::span<const Port> ports);

}  // namespace abut
