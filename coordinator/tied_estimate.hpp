#pragma once

#include <vector>

#include "coordinator/coupling/joint.hpp"
#include "coordinator/estimate.hpp"

namespace abut {

/// What ties of surfaces will pay for, by the bodies that they hang together. Closes the joints
/// that are tied.
std::vector<Estimate::Ties> estimate_ties(const Scene& scene, std::vector<Joint>& joints,
                                          const Bodies& bodies);

}  // namespace abut
