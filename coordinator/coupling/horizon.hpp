#pragma once

#include <span>

#include "coordinator/coupling/bodies.hpp"
#include "coordinator/coupling/joint.hpp"

namespace abut {

/// Time for which no open interface can close [s]: gap over the bound of the closing speed, with
/// the accelerations of body forces, and a margin; infinity when the sides move apart. Reads the
/// latest responses, and notes in the joints how near surfaces are.
double free_flight_horizon(std::span<Joint> joints, const Bodies& bodies);

/// True when all sides stayed apart over a flight of `length` [s] that began where the horizon was
/// asked for: the bound has held.
bool stayed_apart(std::span<const Joint> joints, const Bodies& bodies, double length);

}  // namespace abut
