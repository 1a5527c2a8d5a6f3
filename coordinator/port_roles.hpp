#pragma once

#include "base/yaml_document.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// Reads out of a scene's interfaces what each body is told of its ports (BodyEntry::context), and
/// of the bodies' own keys what that depends on. Keys that are wrong are left to their reader.
/// `elsewhere`: all bodies may read their meshes on other machines, whatever the scene says.
void assign_roles(Scene& scene, const Document& document, bool elsewhere = false);

}  // namespace abut
