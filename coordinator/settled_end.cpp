#include "coordinator/settled_end.hpp"

#include <algorithm>
#include <cmath>

#include "coordinator/record/validity_notes.hpp"

namespace abut {

namespace {

/// Of a whole window, and in how many: loads grow by half a hundredth of what they do in a whole
/// one, of which springs of a hundredth of a body's stiffness bear a hundredth.
constexpr double left_part = 0.02;
constexpr int short_windows = 4;
constexpr double rounded = 1.0e-6;  // of a short window

/// Of what is left until the end, in a window that comes before the last one; and how many of these
/// there are at most: springs that keep 95 % of their force in each have a twentieth of it then.
constexpr double cut_part = 0.15;
constexpr int most_cuts = 60;

double short_window(const TimeWindow& window) { return left_part / short_windows * window.whole; }

}  // namespace

TimeWindow before_settled_end(TimeWindow next, double end) {
  const double piece = short_window(next);
  if (next.end < end - rounded * piece) return next;
  const double begin = end - short_windows * piece;
  const double done = std::floor((next.begin - begin) / piece + rounded);
  const int after = done < 0.0 ? 0 : static_cast<int>(done) + 1;
  if (after < short_windows) next.end = begin + after * piece;
  return next;
}

bool is_after_cut(const TimeWindow& window, double end) {
  return window.begin > end - (1.0 - rounded) * short_window(window);
}

std::optional<double> settled_further(const TimeWindow& window, double end) {
  const double left = end - window.begin;
  if (window.end < end - rounded * left) return std::nullopt;
  if (left < std::pow(1.0 - cut_part, most_cuts) * short_window(window)) return std::nullopt;
  return window.begin + cut_part * left;
}

double borne_of_allowed(Bodies& bodies) {
  double most = 0.0;
  for (int b = 0; b < bodies.count(); ++b)
    if (bodies.describe(b).stabilised)
      most = std::max(most, borne_over_allowed(bodies.describe(b), bodies[b].measure()));
  return most;
}

}  // namespace abut
