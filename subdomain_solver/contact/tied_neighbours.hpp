#pragma once

#include <vector>

#include "base/index.hpp"
#include "contract/port.hpp"
#include "contract/time_window.hpp"
#include "subdomain_solver/substeps.hpp"

namespace abut {

/// How a surface moves because bodies that are tied to its own give way under what presses on it
/// [M.121]. The forces between them are given with a request, and fit what pressed when they were
/// found: in the sweep before, at first when the window began. Of what presses beyond that, the
/// kernel tells the rest.
class TiedNeighbours {
 public:
  /// Whether they give way in this window.
  bool act() const { return acts_; }

  /// A window begins, or is tried again. `kernel`, which must live until its end: of the surface,
  /// for what the tied bodies add; `pressing`: [N] (values) on the surface then.
  void begin(const PortKernel& kernel, const TimeWindow& window, const Substeps& grid,
             std::span<const double> pressing);
  /// Nothing presses in this window.
  void rest() { acts_ = false; }
  /// The substep i is next.
  void aim(int i);
  /// [N] (values) that pressed at its end.
  void settle(std::span<const double> pressing);

  /// [m] (values) at the substep's end, but for what its own force adds.
  std::span<const double> moved() const { return moved_; }
  /// [m/N] (values) that a unit of this value of its own force adds.
  std::span<const double> response(std::size_t value) const;

 private:
  std::size_t width() const { return index(kernel_->width); }
  void recall(int level, int at, double sign, std::span<const double> forces);

  const PortKernel* kernel_ = nullptr;
  bool acts_ = false;
  int substep_ = 0;
  // Of the latest window, not of the state: what it began with is, and sweeps repeat it.
  TimeWindow window_;
  int count_ = 0;
  std::vector<double> expected_, pressed_;  // [N] (substeps + 1, values) at their ends
  std::vector<double> moved_;
};

}  // namespace abut
