#pragma once

#include <string>

#include "contract/port.hpp"

namespace abut {

/// Why whoever goes by these steps [s] (0: any), with forces of this support, cannot take a kernel
/// of so many values (0: any); empty: it can. Steps that rounding alone tells apart are the same.
std::string misfit_of(const PortKernel& kernel, double step, ForceSupport support, int values);

}  // namespace abut
