#include "subdomain_solver/contact/tied_neighbours.hpp"

#include <algorithm>

#include "base/index.hpp"

namespace abut {

void TiedNeighbours::begin(const Substeps& grid, const Waveform& balanced) {
  const std::size_t size = width(), levels = index(grid.count) + 1;
  acts_ = !balanced.empty() && kernel_.count() >= std::max(1, grid.count);
  if (!acts_) return;
  balanced_.resize(levels * size);
  for (std::size_t i = 0; i < levels; ++i)
    balanced.force_at(i == 0 ? grid.begin : grid.time(static_cast<int>(i)),
                      std::span(balanced_).subspan(i * size, size));
  pressed_.assign(levels * size, 0.0);
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
    recall(i, at, -1.0, balanced_);
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
