#pragma once

#include <vector>

#include "coordinator/coupling/schwarz.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// The joints of a run: what the scene says of its interfaces, joined to the bodies. Throws
/// InputError for ports that do not face each other or bodies that cannot take their roles.
std::vector<Joint> make_joints(const Scene& scene, const Bodies& bodies);

Schwarz make_schwarz(const SchwarzSpec& spec);

}  // namespace abut
