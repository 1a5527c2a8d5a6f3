#include "base/key.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace abut {

bool Rule::holds(double value) const {
  const bool low_holds = above_low ? value > low : value >= low;
  const bool high_holds = below_high ? value < high : value <= high;
  return low_holds && high_holds;
}

std::string Rule::words() const {
  const bool bounded_above = std::isfinite(high);
  if (low == 0.0 && !bounded_above) return above_low ? "positive" : "zero or positive";
  const std::string text = range();
  return text.empty() ? "a number" : text;
}

std::string Rule::range() const {
  const bool bounded_below = std::isfinite(low);
  const bool bounded_above = std::isfinite(high);
  if (bounded_below && bounded_above && !above_low && !below_high)
    return fmt::format("between {:.6g} and {:.6g}", low, high);
  const std::string lower = fmt::format("{} {:.6g}", above_low ? "greater than" : "at least", low);
  const std::string upper = fmt::format("{} {:.6g}", below_high ? "less than" : "at most", high);
  if (bounded_below && bounded_above) return lower + " and " + upper;
  if (bounded_below) return lower;
  return bounded_above ? upper : "";
}

std::string index_step(std::size_t index) { return fmt::format("[{}]", index); }

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row[b.size()];
}

std::string nearest(std::string_view word, std::span<const std::string> candidates) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 2) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace abut
