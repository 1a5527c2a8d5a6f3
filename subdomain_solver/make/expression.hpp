#pragma once

#include <array>
#include <functional>
#include <string>

namespace abut {

/// A formula in x, y, z [m] (reference position), t [s] and pi, e.g. "8000 * x * z" or
/// "t < 1e-3 ? t / 1e-3 : 1". Read once, evaluated often. Throws InputError when it cannot be read;
/// `where` says from where it comes. Not for use by several threads at once.
std::function<double(const std::array<double, 3>&, double)> expression(const std::string& text,
                                                                       const std::string& where);

}  // namespace abut
