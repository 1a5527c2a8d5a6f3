#include "coordinator/record/time_words.hpp"

#include <fmt/format.h>

#include <cmath>

namespace abut {

std::string time_words(double seconds) {
  constexpr double minute = 60.0, hour = 3600.0, day = 86400.0;
  if (!std::isfinite(seconds)) return "no known time";
  if (seconds < 9.5) return fmt::format("{:.2g} s", seconds);
  if (seconds < 99.5) return fmt::format("{:.0f} s", seconds);
  const auto two = [seconds](double large, const char* one, double small, const char* other) {
    const double units = std::round(seconds / small), of = large / small;
    return fmt::format("{:.0f} {} {:.0f} {}", std::floor(units / of), one, std::fmod(units, of),
                       other);
  };
  if (seconds < 2.0 * hour - 0.5) return two(minute, "min", 1.0, "s");
  if (seconds < 2.0 * day) return two(hour, "h", minute, "min");
  return two(day, "d", hour, "h");
}

}  // namespace abut
