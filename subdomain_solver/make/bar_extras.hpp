#pragma once

#include "subdomain_solver/bars/bar_interior.hpp"
#include "subdomain_solver/make/body_spec.hpp"
#include "subdomain_solver/place.hpp"

namespace abut {

/// Throws InputError for a point of a bar that is on none of its nodes.
void check_points(const BodySpec& spec, const Place& place);

/// What a scene says of a bar's loads and of its start. Throws InputError.
BarInterior::Extras make_extras(const BodySpec& spec, const Place& place, const Bar& bar);

}  // namespace abut
