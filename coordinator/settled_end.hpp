#pragma once

#include "contract/time_window.hpp"

namespace abut {

/// The next window of a run in which springs stabilise statics. They bear a part of what loads grow
/// by in a window, and let go of it in the next ones: the last window is cut, and what it leaves is
/// done in short ones, in which loads hardly grow.
///   end: of the run [s]
TimeWindow before_settled_end(TimeWindow next, double end);

}  // namespace abut
