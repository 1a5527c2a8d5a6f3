#pragma once

#include <span>

#include "contract/port.hpp"

namespace abut {

/// [m/N] (patterns, width) of a kernel, `lag` >= 0 substeps after that of the force. `at_begin`: to
/// a force at the window's begin alone, `lag` substeps after the first.
inline std::span<const double> response(const PortKernel& kernel, int lag, bool at_begin) {
  const std::vector<double>& of = at_begin ? kernel.begin : kernel.displacement;
  return std::span(of).subspan(index(lag) * kernel.per_step(), kernel.per_step());
}

/// One term of the convolution y(k) = sum over j of c(k - j) f(j): adds to `out` [m] (width) what
/// `sign` times the forces [N] (patterns) move by that response. Forces that are zero cost nothing.
inline void add_response(const PortKernel& kernel, int lag, bool at_begin, double sign,
                         std::span<const double> forces, std::span<double> out) {
  const double* moved = response(kernel, lag, at_begin).data();
  for (const double each : forces) {
    const double force = sign * each;
    if (force != 0.0)
      for (std::size_t v = 0; v < out.size(); ++v) out[v] += force * moved[v];
    moved += out.size();
  }
}

}  // namespace abut
