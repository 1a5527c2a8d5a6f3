#pragma once

#include <array>
#include <span>
#include <string>

#include "coordinator/coupling/joint.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// Interference that the scene wants [m] (Joint::fit): that of a body that is pressed in, or of
/// bodies that have no inertia, or had none in the stage before. `sides`: their names; `where`: the
/// interface's key. Throws InputError where a body that is to be pressed in does not find the
/// contact.
void find_fit(const std::array<std::string, 2>& sides, const std::string& where, const Scene& scene,
              const Bodies& bodies, Joint& joint);

/// Refuses bodies that are to be pressed in and overlap nothing, where all partners are known.
void check_fits(const Scene& scene, std::span<const Joint> joints);

/// Refuses a scene that begins with bodies that have stood in statics before: stages alone do.
/// Throws InputError with the body's key.
void check_nothing_before(const Scene& scene);

}  // namespace abut
