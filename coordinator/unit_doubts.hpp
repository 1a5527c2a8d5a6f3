#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/error.hpp"
#include "base/yaml_document.hpp"
#include "contract/body_facts.hpp"
#include "contract/subdomain.hpp"

namespace abut {

/// Where the numbers of a scene cannot all be meant, most often because of their units: a step far
/// below its limit, bodies of sizes that no scene has together, a density and a stiffness of no
/// material. Each with its key and a remedy; of many equal bodies the first. `bodies` and `facts`
/// as for body_table.
std::vector<InputError> unit_doubts(std::span<const Description* const> bodies,
                                    std::span<const std::optional<BodyFacts>> facts,
                                    const Document& document);

}  // namespace abut
