#pragma once

#include <array>
#include <deque>
#include <vector>

#include "base/archive.hpp"
#include "contract/substeps.hpp"
#include "contract/time_window.hpp"
#include "coordinator/coupling/bodies.hpp"
#include "coordinator/coupling/joint.hpp"

namespace abut {

/// Where the two points of a joint would go over a window without each other. It costs no request:
/// bodies look on after the window before [M.98].
class Trial {
 public:
  /// Asks both sides, with their requests, to look on over the window that will follow this one.
  static void ask(const TimeWindow& window, const Joint& joint, Bodies& bodies);
  /// Of the last replies, and of the impulse that strikes at the window's begin. `grids`: substeps
  /// of the sides. False: nobody looked on, or over another window.
  bool see(const TimeWindow& window, const std::array<Substeps, 2>& grids, const Joint& joint,
           Bodies& bodies);
  /// u [m] (substeps + 1) of a side.
  const Waveform& motion(int side) const { return motions_[side]; }
  void state(Archive& archive);

 private:
  struct Struck {
    double length = 0.0;  // [s] of the window
    int side = 0;
    std::vector<double> moved;  // [m/(N s)]
  };
  const std::vector<double>& answer(int side, const TimeWindow& window, const Joint& joint,
                                    Bodies& bodies);

  std::array<Waveform, 2> motions_;
  std::deque<Struck> answers_;  // to impulses, by window length
};

}  // namespace abut
