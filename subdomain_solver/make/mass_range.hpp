#pragma once

#include "subdomain_solver/make/body_spec.hpp"
#include "subdomain_solver/place.hpp"

namespace abut {

/// Refuses a body whose parts are lighter or heavier [kg] than numbers hold with all their digits,
/// moments of inertia included. Throws InputError at the density.
void check_mass(double lightest, double heaviest, const BodySpec& spec, const Place& place);

}  // namespace abut
