#pragma once

#include <string>

#include "base/yaml_document.hpp"

namespace abut {

/// Whether a body's own keys have its surfaces moved onto their partners before the start: of its
/// specification what the roles of interfaces depend on.
bool is_adjusted(const Document& document, const std::string& body);

}  // namespace abut
