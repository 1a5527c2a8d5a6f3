#pragma once

#include <string>
#include <vector>

#include "subdomain_solver/make/body_spec.hpp"
#include "subdomain_solver/make/constraints.hpp"
#include "subdomain_solver/place.hpp"
#include "subdomain_solver/solid_interior.hpp"

namespace abut {

/// With initial.adjust: moves nodes of the body's ports by the least that takes them out of the
/// surfaces that they may touch, and with adjust_gaps first those onto them that are as near. The
/// mesh changes, so there is no stress; partners stay, and so does what constraints hold. For
/// people: " with 12 nodes moved by up to 0.0001 m"; empty where nothing is asked for. Throws
/// InputError where that cannot be.
std::string adjust_ports(const BodySpec& spec, const Place& place,
                         const std::vector<SolidInterior::PortNodes>& ports,
                         const Constraints& constraints, Mesh& mesh);

}  // namespace abut
