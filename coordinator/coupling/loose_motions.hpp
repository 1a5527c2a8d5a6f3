#pragma once

#include <span>
#include <vector>

#include "coordinator/coupling/bodies.hpp"
#include "coordinator/coupling/joint.hpp"

namespace abut {

/// [m] (points, dim) of a port by a unit of one of its body's loose motions (Description::loose).
std::vector<double> loose_motion(const Description& body, int motion, const PortGeometry& port);

/// Throws InputError where bodies without inertia could move as a whole although they are tied:
/// nothing holds their net, or a tie leaves them a turn.
void check_supports(std::span<const Joint> joints, const Bodies& bodies);

/// Lets one tie of every body that has loose motions carry it.
void share_out_loose_motions(std::span<const Joint> joints, const Bodies& bodies);

}  // namespace abut
