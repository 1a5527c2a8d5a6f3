#include "subdomain_solver/contact/tied_neighbours.hpp"

#include <algorithm>

#include "base/index.hpp"

namespace abut {

void TiedNeighbours::begin(const TimeWindow& window, const Substeps& grid,
                           std::span<const double> pressing) {
  const std::size_t size = width();
  acts_ = kernel_.count() >= grid.count && pressing.size() == size;
  if (!acts_) return;
  const bool again = window.index == window_.index && window.begin == window_.begin &&
                     window.end == window_.end && count_ == grid.count &&
                     pressed_.size() == index(grid.count + 1) * size &&
                     std::ranges::equal(std::span(pressed_).first(size), pressing);
  window_ = window;
  count_ = grid.count;
  if (!again) {
    pressed_.clear();
    for (int i = 0; i <= grid.count; ++i)
      pressed_.insert(pressed_.end(), pressing.begin(), pressing.end());
  }
  expected_ = pressed_;
  moved_.assign(size, 0.0);
}

/// Adds what forces at the end of substep `at` have moved at that of `level`.
void TiedNeighbours::recall(int level, int at, double sign, const std::vector<double>& forces) {
  const std::size_t size = width();
  for (std::size_t k = 0; k < size; ++k) {
    const double force = sign * forces[index(at) * size + k];
    if (force == 0.0) continue;
    const double* to = &kernel_.displacement[(index(level - at) * size + k) * size];
    for (std::size_t v = 0; v < size; ++v) moved_[v] += force * to[v];
  }
}

void TiedNeighbours::aim(int i) {
  if (!acts_) return;
  substep_ = i;
  std::ranges::fill(moved_, 0.0);
  for (int at = 1; at <= i; ++at) {
    recall(i, at, -1.0, expected_);
    if (at < i) recall(i, at, 1.0, pressed_);
  }
}

void TiedNeighbours::settle(std::span<const double> pressing) {
  if (!acts_) return;
  std::ranges::copy(pressing,
                    pressed_.begin() + static_cast<std::ptrdiff_t>(index(substep_) * width()));
}

std::span<const double> TiedNeighbours::response(std::size_t value) const {
  return std::span(kernel_.displacement).subspan(value * width(), width());
}

}  // namespace abut
