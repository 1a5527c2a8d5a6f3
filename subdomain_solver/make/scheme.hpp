#pragma once

#include <functional>

#include "subdomain_solver/make/body_spec.hpp"
#include "subdomain_solver/make/linear_choice.hpp"
#include "subdomain_solver/make/statics.hpp"
#include "subdomain_solver/place.hpp"
#include "subdomain_solver/solid_interior.hpp"
#include "subdomain_solver/time/frequency_watch.hpp"

namespace abut {

/// The ports that a scene gives a solid: sides or node sets of its mesh. Throws InputError.
std::vector<SolidInterior::PortNodes> make_ports(const BodySpec& spec, const Place& place,
                                                 const Mesh& mesh);

/// The mass matrix that a scheme takes.
MassForm mass_form(const BodySpec::Integrator& integrator);

/// The scheme that a scene gives a solid. `stable_limit` tells the stable step [s] of central
/// differences from the start's coordinates, not a number where these are inadmissible; it is
/// asked of no other scheme. `watch` makes what holds them below their limit while the body
/// deforms; none: the limit stays. Where a port is joined, schemes take the form in which a force
/// that is constant in the step does exactly the work by which their energy changes [M.105], if
/// they have one. `linear` solves the equations of a step. `loose` of statics: the rigid motions
/// that supports leave them. The problem must outlive the scheme. Throws InputError.
using MakeWatch = std::function<std::unique_ptr<FrequencyWatch>()>;
SolidInterior::Scheme make_scheme(const BodySpec& spec, const Place& place, const Problem& problem,
                                  const std::vector<SolidInterior::PortNodes>& ports,
                                  const std::function<double()>& stable_limit,
                                  const LinearChoice& linear, const MakeWatch& watch = {},
                                  const LooseMotions& loose = {});

}  // namespace abut
