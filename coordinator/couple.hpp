#pragma once

#include <vector>

#include "coordinator/coupling/broad_phase.hpp"
#include "coordinator/coupling/schwarz.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// The joints of a run: what the scene says of its interfaces, joined to the bodies. Throws
/// InputError for ports that do not face each other or bodies that cannot take their roles. Bodies
/// that are surfaces alone look to who may touch them from then on.
std::vector<Joint> make_joints(const Scene& scene, Bodies& bodies);

/// The joint of two surfaces of a scene where everything may touch everything. Throws InputError
/// for bodies of which neither can find their contact.
Joint make_pair(const Scene& scene, const PortPair& pair, const Bodies& bodies);

/// Its pairs; none where interfaces are written one by one. `joints`: those that are. Throws
/// InputError for bodies that overlap at the start.
BroadPhase make_broad_phase(const Scene& scene, std::span<const Joint> joints,
                            const Bodies& bodies);

/// What a scene says of the kernels of ties.
TieKernelOptions tie_kernel_options(const SchwarzSpec& spec);

/// `alternating`: joints in whose islands bodies answer as if the others stood still.
Schwarz make_schwarz(const SchwarzSpec& spec, std::vector<int> alternating = {});
std::vector<int> alternating_joints(const Scene& scene);

}  // namespace abut
