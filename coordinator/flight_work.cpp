#include "coordinator/flight_work.hpp"

#include <algorithm>
#include <cmath>

#include "coordinator/reply_bytes.hpp"

namespace abut {
namespace {

constexpr double enough = 0.5;          // [s] of work in one request
constexpr double most_windows = 1000;
constexpr double most_bytes = 1.0e8;    // of one reply: well below the limit of a frame, 2.7e8

// [s] per degree of freedom and substep, measured on one core and rounded up: a request costs
// 50 us, so that work taken for ten times what it is costs a run less than a per cent.
constexpr double explicit_bar = 1.0e-8;
constexpr double implicit_bar = 3.0e-7;
constexpr double explicit_solid = 5.0e-8;
constexpr double implicit_solid = 3.0e-6;      // up to so many degrees of freedom; factors of
constexpr double small_factors = 1000.0;       // larger ones grow with the power 3/2

double work_of_a_substep(const Description& body) {
  const double dofs = static_cast<double>(body.dofs);
  const bool is_explicit = std::isfinite(body.stable_step) && body.stable_step > 0.0;
  if (body.dim == 1) return dofs * (is_explicit ? explicit_bar : implicit_bar);
  if (is_explicit) return dofs * explicit_solid;
  return dofs * implicit_solid * std::max(1.0, std::sqrt(dofs / small_factors));
}

}  // namespace

int windows_at_once(double window, int records, std::span<const Description* const> bodies) {
  double work = 0.0;   // [s] of a window; bodies in one process follow one another
  double bytes = 0.0;  // of the largest reply to it
  for (const Description* body : bodies) {
    const double substeps = body->step > 0.0 ? std::ceil(window / body->step - 1.0e-9) : 1.0;
    work += substeps * work_of_a_substep(*body);
    bytes = std::max(bytes, reply_bytes(*body, records, records));
  }
  double windows = most_windows;
  if (work > 0.0) windows = std::min(windows, enough / work);
  if (bytes > 0.0) windows = std::min(windows, most_bytes / bytes);
  return static_cast<int>(std::max(1.0, std::floor(windows)));
}

}  // namespace abut
