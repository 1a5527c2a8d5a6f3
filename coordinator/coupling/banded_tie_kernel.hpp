#pragma once

#include <memory>

#include "coordinator/coupling/tie_band.hpp"
#include "coordinator/coupling/tie_kernel.hpp"

namespace abut {

/// Rows on the rows near them: a body is probed with a number of patterns that does not grow with
/// its faces  [M.110], [M.111]. `lags`: blocks; what a force does after them is left out.
std::unique_ptr<TieKernel> make_banded_tie_kernel(const TieLayout& layout,
                                                  const TieBandWidth& width, int lags,
                                                  Bodies& bodies);

}  // namespace abut
