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

/// A whole step stays the nominal one to the last bit: its factors and kernels are reused.
double last_of(double length, int count, double step) {
  const double rest = length - (count - 1) * step;
  return std::abs(rest - step) < remainder_tolerance * step ? step : rest;
}

RunError too_many(double length, double count, double step) {
  return {fmt::format("a request of {:g} s would take {:g} substeps of {:g} s, more than {:g}",
                      length, count, step, most_substeps),
          "", "Give a shorter time.window or a longer step."};
}
}  // namespace

Substeps Substeps::divide(double begin, double end, double step) {
  const double length = end - begin;
  if (step <= 0.0) step = length;
  Substeps part{begin, end, step, step, 0};
  if (length <= 0.0) return part;
  const double exact = length / step;
  if (!(exact <= most_substeps)) {
    throw too_many(length, exact, step);
  }
  part.count =
      count_within(std::ceil(exact - remainder_tolerance), 1, static_cast<int>(most_substeps));
  part.last = last_of(length, part.count, step);
  return part;
}

Substeps Substeps::divide(const TimeWindow& window, double step, int otherwise) {
  const double first = window.stop(1) - window.begin;
  Substeps part = divide(window.begin, window.stop(1), step > 0.0 ? step : first / otherwise);
  if (window.windows == 1) return part;
  const double all = static_cast<double>(window.windows) * part.count;
  if (!(all <= most_substeps)) throw too_many(window.length(), all, part.step);
  part.end = window.end;
  part.each = part.count;
  part.count = static_cast<int>(all);
  part.shares = step <= 0.0;
  part.row = window;
  return part;
}

double Substeps::length_in_row(int i) const {
  const int k = (i - 1) / each;
  const double window = row.stop(k + 1) - row.stop(k);
  if (shares) return window / each;
  return i % each == 0 ? last_of(window, each, step) : step;
}

double Substeps::time_in_row(int i) const {
  const int k = i / each, j = i % each;
  const double from = row.stop(k);
  return j == 0 ? from : from + j * (shares ? (row.stop(k + 1) - from) / each : step);
}

bool Substeps::matches(const std::vector<double>& times) const {
  if (times.size() != index(count) + 1) return false;
  for (int i = 0; i <= count; ++i) {
    if (times[i] != time(i)) return false;
  }
  return true;
}

}  // namespace abut
