#pragma once

#include <vector>

#include "base/index.hpp"
#include "contract/port.hpp"
#include "contract/waveform.hpp"
#include "subdomain_solver/substeps.hpp"

namespace abut {

/// Adds the compliance of bodies tied to this surface [M.121]. The tie forces of a request balance
/// the contact force of an earlier sweep, which comes with the request (BoundaryData::balanced);
/// the kernel adds the effect of what presses beyond that.
class TiedNeighbours {
 public:
  /// Whether they respond in this window.
  bool act() const { return acts_; }

  /// A window begins. `kernel`, which must live until its end: of the surface, for what the tied
  /// bodies add. `balanced`: f [N] on all points of the surface. Absent: they do not respond.
  void begin(const PortKernel& kernel, const Substeps& grid, const Waveform& balanced);
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
  std::vector<double> balanced_, pressed_;  // [N] (substeps + 1, values) at their ends
  std::vector<double> moved_;
};

}  // namespace abut
