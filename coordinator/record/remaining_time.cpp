#include "coordinator/record/remaining_time.hpp"

#include <algorithm>
#include <cstddef>

namespace abut {

namespace {

constexpr std::size_t most_samples = 2000;
constexpr double settled = 1.0;  // [s] before which nothing is told

}  // namespace

void RemainingTime::add(double wall, double part) {
  samples_.push_back({wall, part});
  if (samples_.size() <= most_samples) return;
  std::size_t kept = 0;  // every other one of them is enough
  for (std::size_t k = 0; k < samples_.size(); k += 2) samples_[kept++] = samples_[k];
  samples_.resize(kept);
}

std::optional<double> RemainingTime::left(double wall, double part) const {
  const auto at = std::ranges::lower_bound(samples_, 0.5 * wall, {}, &Sample::wall);
  const Sample from = at == samples_.end() ? samples_.front() : *at;
  const double rate = (part - from.part) / (wall - from.wall);
  if (!(rate > 0.0) || !(wall > settled)) return std::nullopt;
  return (1.0 - part) / rate;
}

}  // namespace abut
