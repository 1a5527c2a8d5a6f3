#pragma once

#include "contract/field.hpp"
#include "contract/subdomain.hpp"
#include "coordinator/coupling/bodies.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// Whether a body is a surface alone: all cells of its grid are facets.
bool is_surface_alone(const Description& body, const Grid& grid);

/// Tools that are surfaces alone have no inside, and the order of their nodes says little: each
/// part of their ports that hangs together looks to where more is seen of it by the ports that may
/// touch it, as they stand in the reference ([M.159]). Asks immovable bodies for their grids.
void turn_surfaces_alone(const Scene& scene, Bodies& bodies);

}  // namespace abut
