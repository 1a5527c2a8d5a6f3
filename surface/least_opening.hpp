#pragma once

#include <span>
#include <vector>

#include "surface/sparse_rows.hpp"

namespace abut {

/// Adds to d (n) what opens all rows, gap + rows d >= 0, and closes those that are `met` (rows),
/// gap + rows d = 0, by the least sum of squares; `rows` are over the n coordinates. One row after
/// the other, each by what it lacks, until none lacks more than `within` [m] or for most_sweeps
/// (Hildreth 1957): rows may depend on each other.
void least_opening(const SparseRows& rows, std::span<const double> gaps, std::span<const char> met,
                   double within, int most_sweeps, std::span<double> d);

}  // namespace abut
