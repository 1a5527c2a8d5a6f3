#pragma once

#include <vector>

#include "contract/port.hpp"
#include "contract/waveform.hpp"
#include "subdomain_solver/substeps.hpp"

namespace abut {

/// Adds the compliance of bodies tied to this surface [M.121]. The tie forces of a request balance
/// the contact force of an earlier sweep, which comes with the request (BoundaryData::balanced);
/// the kernel adds the effect of what presses beyond that.
class TiedNeighbours {
 public:
  void take(PortKernel kernel) { kernel_ = std::move(kernel); }
  /// Whether they respond in this window.
  bool act() const { return acts_; }

  /// A window begins. `balanced`: f [N] on all points of the surface. Absent, or without a kernel:
  /// they do not respond.
  void begin(const Substeps& grid, const Waveform& balanced);
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
  std::size_t width() const { return static_cast<std::size_t>(kernel_.width); }
  void recall(int level, int at, double sign, const std::vector<double>& forces);

  PortKernel kernel_;
  bool acts_ = false;
  int substep_ = 0;
  std::vector<double> balanced_, pressed_;  // [N] (substeps + 1, values) at their ends
  std::vector<double> moved_;
};

}  // namespace abut
