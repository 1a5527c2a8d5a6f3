#pragma once

#include <optional>

#include "contract/time_window.hpp"
#include "coordinator/coupling/bodies.hpp"

namespace abut {

/// The next window of a run in which springs stabilise statics. They bear a part of what loads grow
/// by in a window, and let go of it in the next ones: the last window is cut, and what it leaves is
/// done in short ones, in which loads hardly grow.
///   end: of the run [s]
TimeWindow before_settled_end(TimeWindow next, double end);

/// Whether a window begins within the last of these, which was cut as springs bore too much after
/// it.
bool is_after_cut(const TimeWindow& window, double end);

/// [s] Where a window that would end a run ends instead, so that springs let go of more. Empty: it
/// does not end the run, or has been cut as often as is worth while.
std::optional<double> settled_further(const TimeWindow& window, double end);

/// What springs bear of the forces on the bodies that they stabilise, over what they may bear at
/// the end of a run: the largest. Asks these bodies for their measures.
double borne_of_allowed(Bodies& bodies);

}  // namespace abut
