#pragma once

#include "coordinator/coupling/bodies.hpp"
#include "coordinator/coupling/interface.hpp"

namespace abut {

/// Index of the side that becomes kinematic: the softer or lighter one, told by what a constant
/// unit force moves over a window (port kernels); within a factor of 3 the one with the finer mesh,
/// then the finer step, then the first. An immovable or rigid side never is (docs/METHOD.md,
/// roles). `length` [s]: a whole window.
int kinematic_side(const Interface& interface, Bodies& bodies, double length);

/// The same for a tied interface: the side of the larger step. Its force then varies no faster than
/// it steps, and the other side's means of it take nothing away; with the roles exchanged the
/// trapezoidal rule gains energy over 1e5 substeps.
int tied_side(const Interface& interface, Bodies& bodies, double length);

/// Index of the side whose substeps carry the force in the parallel form: the one with the longer
/// steps.
int coarser_side(const Interface& interface, const Bodies& bodies);

/// Stable step [s] of an explicit Neumann side whose massive node takes the kinematic side's
/// contact spring beside its own: by Gershgorin's rows, 2 / sqrt(w^2 + k / m)  [M.53]. Infinity
/// where the side is implicit, or has a contact layer of its own, or the partner is no spring.
double stable_step_in_contact(const Interface& interface, Bodies& bodies, double length);

}  // namespace abut
