#include "subdomain_solver/contact/tied_neighbours.hpp"

#include <algorithm>

#include "contract/kernel.hpp"

namespace abut {

void TiedNeighbours::begin(const PortKernel& kernel, const Substeps& grid,
                           const Waveform& balanced) {
  kernel_ = &kernel;
  const std::size_t size = width(), levels = index(grid.count) + 1;
  acts_ = !balanced.empty() && kernel.count() >= std::max(1, grid.count);
  if (!acts_) return;
  balanced_.resize(levels * size);
  for (std::size_t i = 0; i < levels; ++i)
    balanced.force_at(i == 0 ? grid.begin : grid.time(static_cast<int>(i)),
                      std::span(balanced_).subspan(i * size, size));
  pressed_.assign(levels * size, 0.0);
  moved_.assign(size, 0.0);
}

/// Adds what forces at the end of substep `at` have moved at that of `level`.
void TiedNeighbours::recall(int level, int at, double sign, std::span<const double> forces) {
  add_response(*kernel_, level - at, false, sign, forces.subspan(index(at) * width(), width()),
               moved_);
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
  return std::span(kernel_->displacement).subspan(value * width(), width());
}

}  // namespace abut
