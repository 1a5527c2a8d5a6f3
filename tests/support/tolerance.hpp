#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace abut {

/// Bound on what `operations` roundings of a number of size `scale` add up to.
inline double roundoff(double operations, double scale) {
  return operations * std::numeric_limits<double>::epsilon() * std::abs(scale);
}

/// Bound on a relative error made by stopping an iteration at `tolerance` in each of `windows`
/// windows, if all those errors had one sign.
inline double iteration(double tolerance, double windows = 1.0) { return tolerance * windows; }

/// Order of convergence seen between two errors on meshes (or steps) whose sizes differ by `ratio`.
inline double observed_order(double coarse, double fine, double ratio = 2.0) {
  return std::log(std::abs(coarse / fine)) / std::log(ratio);
}

/// Largest difference of two lists, compared as far as both go.
inline double largest_difference(std::span<const double> a, std::span<const double> b) {
  double most = a.size() == b.size() ? 0.0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    most = std::fmax(most, std::abs(a[i] - b[i]));
  return most;
}

/// Largest size in a list: the scale of its round-off.
inline double largest_size(std::span<const double> a) {
  double most = 0.0;
  for (double x : a) most = std::fmax(most, std::abs(x));
  return most;
}

}  // namespace abut
