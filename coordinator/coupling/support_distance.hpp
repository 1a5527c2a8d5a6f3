#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "coordinator/coupling/joint.hpp"

namespace abut {

/// Two sides that are or may come in contact, or that are tied.
struct Neighbours {
  std::array<Side, 2> sides;
  bool tied = false;
};

/// By body, the fewest contacts between it and a body that does not move as a whole: 0 of one that
/// supports hold, or that is tied to such a one, or has inertia; none of one that nothing holds.
std::vector<std::optional<int>> support_distances(std::span<const Neighbours> all,
                                                  const Bodies& bodies);

/// Tells `bodies` these distances, where some have no inertia: of `joints` and of contacts that
/// become some (see contact_finder).
void see_supports(std::span<const Joint> joints, std::span<const std::array<Side, 2>> contacts,
                  Bodies& bodies);

}  // namespace abut
