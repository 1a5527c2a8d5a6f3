#include "subdomain_solver/contact/tied_neighbours.hpp"

#include <algorithm>

#include "contract/kernel.hpp"

namespace abut {

void TiedNeighbours::begin(const PortKernel& kernel, const TimeWindow& window,
                           const Substeps& grid, std::span<const double> pressing) {
  kernel_ = &kernel;
  const std::size_t size = width();
  acts_ = kernel.count() >= grid.count && pressing.size() == size;
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
void TiedNeighbours::recall(int level, int at, double sign, std::span<const double> forces) {
  add_response(*kernel_, level - at, false, sign, forces.subspan(index(at) * width(), width()),
               moved_);
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
  return std::span(kernel_->displacement).subspan(value * width(), width());
}

}  // namespace abut
