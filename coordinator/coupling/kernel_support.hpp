#pragma once

#include "coordinator/coupling/bodies.hpp"

namespace abut {

/// The kernel of the same body for forces at levels (ForceSupport::nodal), each over its dual cell,
/// where it was told for forces that are constant in substeps: of a force at a level half acts in
/// the substep that ends there and half in the next, and of the force at the begin half in the
/// first [M.90].
PortKernel for_levels(PortKernel kernel);

/// Throws RunError where a kernel of a surface is not for forces that are constant in substeps, by
/// which ties press. `by`: the other side of the tie.
void require_for_substeps(const PortKernel& kernel, const Side& pressed, const Side& by,
                          const Bodies& bodies);

}  // namespace abut
