#pragma once

#include <string>

#include "base/yaml_document.hpp"
#include "contract/body_facts.hpp"
#include "subdomain_solver/make/body_spec.hpp"
#include "subdomain_solver/make/material_doubt.hpp"
#include "subdomain_solver/place.hpp"

namespace abut {

/// Of a body of a scene, which make_body takes. Throws InputError.
BodyFacts body_facts(const Document& document, const std::string& path, const BodyContext& context);

/// Of the numbers of a material, where they cannot both be meant: a sentence or two that go before
/// the remedy of what they lead to, with a blank behind them; else nothing.
std::string doubts_first(const DensityAndStiffness& numbers, const Place& place);

}  // namespace abut
