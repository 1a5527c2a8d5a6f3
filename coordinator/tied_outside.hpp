#pragma once

#include <optional>

#include "coordinator/coupling/bodies.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// A port with the ports of its body that are tied, where these close it: what lies beyond a joint
/// is not behind the rest of the outside. Nothing: it encloses nothing with them either. Places and
/// facets alone.
std::optional<PortGeometry> tied_outside(const Scene& scene, const Side& side,
                                         const Bodies& bodies);

}  // namespace abut
