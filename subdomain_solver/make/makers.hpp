#pragma once

#include "subdomain_solver/interior.hpp"
#include "subdomain_solver/make/body_spec.hpp"
#include "subdomain_solver/place.hpp"

namespace abut {

// One maker per kind of body, for make_body, which has read the specification. Each throws
// InputError with file, line and key.

/// Of finite elements.
std::unique_ptr<Interior> make_solid(const BodySpec& spec, const Place& place);
std::unique_ptr<Interior> make_modal(const BodySpec& spec, const Place& place);
std::unique_ptr<Interior> make_rigid(const BodySpec& spec, const Place& place);
std::unique_ptr<Interior> make_tool(const BodySpec& spec, const Place& place);
std::unique_ptr<Interior> make_pair(const BodySpec& spec, const Place& place);

}  // namespace abut
