#pragma once

#include <string>

#include "base/yaml_document.hpp"
#include "subdomain_solver/make/body_spec.hpp"

namespace abut {

/// A body of a scene, with what its joints make of it. Throws InputError.
BodySpec read_body(const Document& scene, const std::string& path);

}  // namespace abut
