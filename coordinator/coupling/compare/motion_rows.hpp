#pragma once

#include "coordinator/coupling/tie_rows.hpp"

namespace abut {

/// The rows of make_overlap_rows, with forces that act on a row's own side alone: motions alone
/// pass  [M.116].
TieRows make_motion_rows(const PortGeometry& one, const PortGeometry& other);

}  // namespace abut
