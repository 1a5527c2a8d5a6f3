#pragma once

#include "coordinator/coupling/tie_rows.hpp"

namespace abut {

/// Rows of both sides, each a dashpot with the partner's force, of `impedance` [kg/s] in all,
/// shared by area  [M.117]. No rows: as in make_tie_rows.
TieRows make_dashpot_rows(const PortGeometry& one, const PortGeometry& other, double impedance);

}  // namespace abut
