#pragma once

#include <span>
#include <vector>

#include "coordinator/coupling/joint.hpp"

namespace abut {

/// By body, the first one of those with which it hangs together by ties; itself where nothing ties
/// it. Where everything may touch everything, bodies of one whole do not touch each other: their
/// outsides are on each other along the rims of the joints from the start.
std::vector<int> tied_wholes(std::span<const Joint> joints, int bodies);

}  // namespace abut
