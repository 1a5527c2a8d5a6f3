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

/// Adds to `out` [m] (width) what `sign` times the forces [N] (patterns) move by one step's
/// responses of a kernel, or by numbers [m/N] that lie as these do. Forces that are zero cost
/// nothing.
inline void add_moved(const PortKernel& kernel, std::span<const double> responses, double sign,
                      std::span<const double> forces, std::span<double> out) {
  const double* moved = responses.data();
  if (kernel.band.empty()) {
    for (const double each : forces) {
      const double force = sign * each;
      if (force != 0.0)
        for (std::size_t v = 0; v < out.size(); ++v) out[v] += force * moved[v];
      moved += out.size();
    }
    return;
  }
  const std::size_t dim = index(kernel.band.dim);
  for (std::size_t p = 0; p < kernel.band.points(); ++p) {
    for (const std::int32_t q : kernel.band.of(p)) {
      double* to = &out[index(q) * dim];
      for (std::size_t j = 0; j < dim; ++j, moved += dim) {
        const double force = sign * forces[p * dim + j];
        for (std::size_t i = 0; force != 0.0 && i < dim; ++i) to[i] += force * moved[i];
      }
    }
  }
}

/// One term of the convolution y(k) = sum over j of c(k - j) f(j): adds to `out` [m] (width) what
/// `sign` times the forces [N] (patterns) move by that response. Forces that are zero cost nothing.
inline void add_response(const PortKernel& kernel, int lag, bool at_begin, double sign,
                         std::span<const double> forces, std::span<double> out) {
  add_moved(kernel, response(kernel, lag, at_begin), sign, forces, out);
}

}  // namespace abut
