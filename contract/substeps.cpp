#include "contract/substeps.hpp"

#include <cmath>

#include <fmt/format.h>

#include "base/count.hpp"
#include "base/error.hpp"
#include "base/index.hpp"

namespace abut {

namespace {
/// A remainder below this fraction of a step is round-off of the window's length, not a step.
constexpr double remainder_tolerance = 1.0e-6;
}  // namespace

Substeps Substeps::divide(double begin, double end, double step) {
  const double length = end - begin;
  if (step <= 0.0) step = length;
  Substeps part{begin, end, step, step, 0};
  if (length <= 0.0) return part;
  const double exact = length / step;
  if (!(exact <= most_substeps)) {
    throw RunError(fmt::format("a request of {:g} s would take {:g} substeps of {:g} s, more than "
                               "{:g}",
                               length, exact, step, most_substeps),
                   "", "Give a shorter time.window or a longer step.");
  }
  part.count =
      count_within(std::ceil(exact - remainder_tolerance), 1, static_cast<int>(most_substeps));
  const double rest = length - (part.count - 1) * step;
  // A whole step stays the nominal one to the last bit: its factors and kernels are reused.
  const bool whole = std::abs(rest - step) < remainder_tolerance * step;
  part.last = whole ? step : rest;
  return part;
}

bool Substeps::matches(const std::vector<double>& times) const {
  if (times.size() != index(count) + 1) return false;
  for (int i = 0; i <= count; ++i) {
    if (times[index(i)] != time(i)) return false;
  }
  return true;
}

}  // namespace abut
