#pragma once

#include <span>

#include "coordinator/coupling/bodies.hpp"
#include "coordinator/coupling/joint.hpp"

namespace abut {

/// Chooses the kinematic sides of all joints whose roles the scene leaves open, before the first
/// window and for the whole run (docs/METHOD.md, roles): of contact the softer or lighter side,
/// told by what a constant unit force moves over a window (port kernels); within a factor of 3 the
/// one with the finer mesh, then the finer step, then the first. Of ties with unlike steps the side
/// of the larger one: its force then varies no faster than it steps, and the other side's means of
/// it take nothing away; with the roles exchanged the trapezoidal rule gains energy over 1e5
/// substeps. A side that takes no obstacles never is.
///
/// The roles are those of one order of all bodies: joints are settled one by one, the clearest
/// first, and one that would close a circle is turned around. Throws InputError when roles that the
/// scene fixes, or that only one side can take, go round in a circle.
/// `window` [s]: a whole one; `parallel`: forces are iterated, at the coarser side's substeps.
void choose_roles(std::span<Joint> joints, Bodies& bodies, double window, bool parallel);

/// Index of the side whose substeps carry the force in the parallel form: the one with the longer
/// steps.
int coarser_side(const Joint& joint, const Bodies& bodies);

/// Stable step [s] of an explicit Neumann side whose massive node takes the kinematic side's
/// contact spring beside its own: by Gershgorin's rows, 2 / sqrt(w^2 + k / m)  [M.53]. Infinity
/// where the side is implicit, or has a contact layer of its own, or the partner is no spring.
double stable_step_in_contact(const Joint& joint, Bodies& bodies, double length);

}  // namespace abut
