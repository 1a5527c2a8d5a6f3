#pragma once

#include <span>

namespace abut {

/// Unit vectors across a unit normal (dim) and each other, which depend on it alone: one in the
/// plane, two in space; `out` is (dim - 1, dim).
void tangents(int dim, const double* normal, std::span<double> out);

}  // namespace abut
