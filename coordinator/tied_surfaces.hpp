#pragma once

#include <span>

#include "coordinator/coupling/joint.hpp"
#include "coordinator/interface_spec.hpp"

namespace abut {

/// Two surfaces that a scene ties. Throws InputError where the faces do not meet, or a body cannot
/// be joined.
Joint make_tied_joint(const InterfaceSpec& spec, std::array<Side, 2> sides, const Bodies& bodies);

/// Throws InputError where a body without inertia is tied and may touch another one: what the
/// iteration accepts of both together can be far off (a sleeve in a tube: by 40 % of the pressure).
/// `everything`: whether any port that is not tied may touch.
void check_still_contact(std::span<const Joint> joints, bool everything, const Bodies& bodies);

}  // namespace abut
