#pragma once

#include <span>

#include "coordinator/coupling/bodies.hpp"
#include "coordinator/coupling/joint.hpp"

namespace abut {

/// Time for which no open interface can close [s]: gap over the bound of the closing speed, with
/// the accelerations of body forces, and a margin; infinity when the sides move apart. Reads the
/// latest responses.
double free_flight_horizon(std::span<const Joint> joints, const Bodies& bodies);

/// True when the ranges that the ports swept, window by window, stay apart: the bound has held.
bool stayed_apart(std::span<const Joint> joints, const Bodies& bodies);

}  // namespace abut
