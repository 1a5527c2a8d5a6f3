#include "coordinator/record/body_meter.hpp"

#include <algorithm>

namespace abut {

void BodyMeter::start() {
  if (under_way_++ > 0) return;
  began_ = std::chrono::steady_clock::now();
  std::ranges::fill(computed_, 0.0);
}

void BodyMeter::finish(std::size_t body, double computed) {
  computed_[body] = computed;
  ++calls_[body];
  if (--under_way_ > 0) return;
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - began_;
  double together = 0.0;
  for (const double seconds : computed_) together += seconds;
  const double part = together > wall.count() ? wall.count() / together : 1.0;
  for (std::size_t b = 0; b < waited_.size(); ++b) waited_[b] += part * computed_[b];
}

}  // namespace abut
