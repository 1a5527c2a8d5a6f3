#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contract/outcome.hpp"
#include "coordinator/coupling/joint.hpp"

namespace abut {

/// What is left where velocities could not be made one.
struct UnlikeStart {
  const Joint* joint = nullptr;
  double speed = 0.0;  // [m/s] by which the sides differ
  std::string body;    // that takes no impulses
};

/// Makes the velocities of tied surfaces one before the first window, by impulses between them that
/// are those of a plastic impact  [M.122]: with rows G of all ties and masses M,
///   G M^-1 G^T p = G v,   v <- v - M^-1 G^T p
/// which takes 1/2 p . G v of the energy, and never adds any, whatever the bodies' stiffnesses,
/// steps and supports are. Bodies have told of the begin. Ties of bodies that take no impulses, and
/// those by motions alone or dashpots, stay as they are; of the former `unlike` tells.
[[nodiscard]] std::optional<Failed> unite_velocities(std::span<const Joint> joints, double time,
                                                     Bodies& bodies,
                                                     std::vector<UnlikeStart>& unlike);

}  // namespace abut
