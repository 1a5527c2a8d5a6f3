#pragma once

#include <cstddef>
#include <vector>

namespace abut {

/// The inner loops of the explicit bar over nodes [first, last) of uniform elements, whose
/// neighbours exist. Compiled for several instruction sets; elementwise, so that all of them give
/// the same bits.

/// v_i += g (u_{i+1} - 2 u_i + u_{i-1}) + shift, then u_i += dt v_i, in one sweep through memory.
void kick_drift_nodes(double* u, double* v, std::size_t first, std::size_t last, double g,
                      double shift, double dt);

/// v_i += g (s_{i+1} - 2 s_i + s_{i-1}) + shift.
void kick_nodes(const double* s, double* v, std::size_t first, std::size_t last, double g,
                double shift);

/// u_i += dt v_i.
void drift_nodes(double* u, const double* v, std::size_t first, std::size_t last, double dt);

/// out_i = u_i + ratio (2 t_i - t_{i-1} - t_{i+1}): one Horner pass of the dispersion correction.
void smooth_nodes(const double* u, const double* t, double* out, std::size_t first,
                  std::size_t last, double ratio);

/// Room for `n` numbers in a buffer, placed within packs as another array is: passes over arrays
/// that lie differently cost up to a tenth more, and the heap would decide.
double* placed_like(const double* other, std::size_t n, std::vector<double>& buffer);

}  // namespace abut
