#pragma once

#include <string>

#include "base/yaml_document.hpp"

namespace abut {

/// Whether an interface of the scene lets a body's port touch another one. The scene may be without
/// interfaces: a body alone.
bool touches(const Document& scene, const std::string& body, const std::string& port);

}  // namespace abut
