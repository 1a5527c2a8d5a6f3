#pragma once

#include <functional>
#include <span>

#include "coordinator/coupling/tie_layout.hpp"

namespace abut {

/// Forces of one end's rows (width) of a pattern.
using FillForces = std::function<void(int pattern, std::span<double> forces)>;
/// [m] (width) by which the rows of an end have moved at the end of step `later` (from 0) under a
/// pattern, which pressed in the first step.
using TakeMotion = std::function<void(int pattern, int later, const TieLayout::End& of,
                                      std::span<const double> moved)>;

/// What loose motions of a body do: a unit of each moves rows, moves what their forces act on, and
/// leaves over [N/m] (motions).
struct TakeLoose {
  TakeMotion motion, acted_on;
  std::function<void(int motion, std::span<const double> left)> left;
};

/// Presses a body at rest with patterns of forces of one of its ends' rows, and tells how the rows
/// of all its ends move within `steps`: so many patterns in a request that its reply is no burden.
void press(const TieLayout& layout, const TieLayout::Part& part, const TieLayout::End& by,
           int patterns, int steps, const FillForces& fill, const TakeMotion& take, Bodies& bodies,
           const TakeLoose& loose = {});

}  // namespace abut
