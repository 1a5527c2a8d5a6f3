#pragma once

#include <string>

#include "base/yaml_document.hpp"
#include "contract/body_facts.hpp"
#include "subdomain_solver/make/body_spec.hpp"

namespace abut {

/// Of a body of a scene, which make_body takes. Throws InputError.
BodyFacts body_facts(const Document& document, const std::string& path, const BodyContext& context);

}  // namespace abut
