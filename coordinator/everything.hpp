#pragma once

#include <span>

#include "base/yaml_document.hpp"
#include "contract/subdomain.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// Rules of a scene where everything may touch everything (contact.everything), whose bodies are
/// known: each is of two or three dimensions and has a surface, no two of its ports have a facet in
/// common, which would touch twice, and of any two bodies one can find contact. Bodies in the
/// scene's order; null: not known yet. Throws InputError.
void validate_everything(const Scene& scene, std::span<const Description* const> bodies,
                         const Document& document);

}  // namespace abut
