#pragma once

#include "coordinator/coupling/joint.hpp"
#include "coordinator/interface_spec.hpp"

namespace abut {

/// Two surfaces that a scene ties. Throws InputError where the faces do not meet, or a body cannot
/// be joined.
Joint make_tied_joint(const InterfaceSpec& spec, std::array<Side, 2> sides, const Bodies& bodies);

}  // namespace abut
