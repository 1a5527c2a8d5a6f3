#pragma once

#include <optional>
#include <vector>

#include "coordinator/coupling/bodies.hpp"
#include "coordinator/coupling/interface.hpp"

namespace abut {

/// A first touch inside a window.
struct Closing {
  double time = 0.0;   // [s] where the gap crosses zero
  double speed = 0.0;  // [m/s] at which it does
};

/// Overlap criterion: an open interface closes where its gap becomes zero or less. Looks at every
/// substep of both bodies after the window's begin, with motion linear between substeps. Within one
/// of the coarser side's substeps after a release it stays open: the release itself was judged no
/// finer than that.
std::optional<Closing> overlap_criterion(const Interface& interface, const Bodies& bodies);

/// A release inside a window.
struct Opening {
  double crossing = 0.0;  // [s] where the contact force crosses zero
  // [s] end of the last substep that is still in contact: both bodies stop there
  double state = 0.0;
};

/// Compression criterion with persistence: a closed interface stays closed as long as the contact
/// force compresses. Judged on the coarser side's force, mean over its own substeps: single values
/// of the finer side spike.
/// `floor` [N]: forces below it count as none.
std::optional<Opening> compression_criterion(const Interface& interface, const Bodies& bodies,
                                             double floor);

/// Largest contact force [N] on the kinematic side in the latest responses.
double peak_force(const Interface& interface, const Bodies& bodies);

/// Impulse [N s] that gives massive contact nodes a common velocity: a plastic impact of the nodes
/// alone, exact in momentum; negative where they part. 0 when a side does not tell its node's mass.
double closing_impulse(const Interface& interface, const Bodies& bodies);

/// Release impulse [N s] after contact of massive contact nodes that take kicks: gives back what
/// contact captured, as far as the nodes' neighbours can take it [M.13]. 0 when a
/// side does not keep that account.
double release_impulse(const Interface& interface, const Bodies& bodies);

}  // namespace abut
