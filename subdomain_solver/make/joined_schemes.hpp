#pragma once

#include "base/yaml_document.hpp"

namespace abut {

/// Whether all bodies that a scene ties to others integrate alike: by the same scheme, of the same
/// step and weights.
bool joined_bodies_step_alike(const Document& scene);

}  // namespace abut
