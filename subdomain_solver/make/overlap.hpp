#pragma once

#include <vector>

#include "subdomain_solver/make/body_spec.hpp"
#include "subdomain_solver/place.hpp"
#include "subdomain_solver/solid_interior.hpp"

namespace abut {

/// Where interfaces say that bodies overlap: cells that lie in a partner keep their share of the
/// material [M.114], and ports go on with the partner's side where it lies inside this body
/// [M.113]. Both processes find the same out of both meshes. Throws InputError where bodies do not
/// overlap as their sides say. Partners that are no finite elements are left to the coordinator.
void overlap_partners(const BodySpec& spec, const Place& place, Mesh& mesh,
                      std::vector<SolidInterior::PortNodes>& ports);

}  // namespace abut
