#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coordinator/coupling/joint.hpp"
#include "coordinator/passive/passive_ties.hpp"
#include "coordinator/passive/touching_surfaces.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// All pairs of surfaces of a run that may touch.
std::vector<TouchingPair> touching_pairs(const Scene& scene, std::span<const Joint> joints,
                                         const Bodies& bodies);
/// All surfaces of a run that are one; none where bodies overlap, or dashpots join them.
std::optional<std::vector<PassiveTie>> passive_ties(const Scene& scene,
                                                    std::span<const Joint> joints,
                                                    const Bodies& bodies);
/// Whether neither side can find the contact of surfaces, or of points on a line, but in its
/// passive form.
bool only_passive(const Joint& joint, const Bodies& bodies);
/// Points that meet passively need a length, of which their distances are small parts: throws
/// InputError where neither of two tells a spacing.
void require_spacing(const Joint& joint, const Bodies& bodies, const std::string& where);

}  // namespace abut
