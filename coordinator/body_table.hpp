#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contract/body_facts.hpp"
#include "contract/subdomain.hpp"

namespace abut {

/// Extent, mass, wave speed and stable step over step of bodies that are known, one row each; many
/// equal ones that follow each other, as copies do, share one. `bodies` and `facts` are in the
/// scene's order, null and none where a body is not known.
std::string body_table(std::span<const Description* const> bodies,
                       std::span<const std::optional<BodyFacts>> facts);

/// [s] up to which explicit steps of the body are stable: its own limit, or where it is implicit
/// that of its mesh. 0: there is none, or it is not known.
double stable_limit(const Description& body, const BodyFacts& facts);

}  // namespace abut
