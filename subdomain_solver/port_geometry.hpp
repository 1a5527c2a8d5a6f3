#pragma once

#include <string>
#include <vector>

#include "contract/port.hpp"
#include "subdomain_solver/fe/fe_model.hpp"

namespace abut {

/// The surface of a side of the mesh: points, area-averaged normals, facets; in the reference. Its
/// facets are segments, triangles and bilinear quadrilaterals: those of second order are divided at
/// their nodes, and `parts` tells so. A node set has neither normals nor facets, the end of a bar
/// no facets. `nodes`: of the side, sorted.
PortGeometry port_geometry(const FeModel& model, const std::string& side,
                           const std::vector<std::int32_t>& nodes);

}  // namespace abut
