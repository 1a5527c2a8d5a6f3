#pragma once

#include <cstddef>
#include <vector>

#include "base/archive.hpp"
#include "contract/port.hpp"

namespace abut {

/// Wanted interference of a body with its partners: gaps are larger than they are by what is left
/// of the overlap as it is drawn, which is all of it when the run begins and nothing in the end
/// [M.137]. What that presses in works on the bodies.
class Interference {
 public:
  /// `over`: [s] in which it grows, 0: it is there at once.
  explicit Interference(double over) : over_(over) {}

  /// The next partner, with the deepest overlap of the rows that its surface and the port's have.
  void meet(const PortGeometry& own, const PortGeometry& other, bool points);
  /// Of what partners that are met later have in the state, nothing is there yet.
  void begin(double time);
  /// [m] by which the gaps to a partner are larger at a time.
  double left(std::size_t partner, double time) const;
  /// The substep that ends at a time is done, with so much force [N] on the partner's rows.
  void settle(std::size_t partner, double time, double force);
  /// All of it is there from now on.
  void end();
  double work() const;  // [J] on the bodies, since the run began

  void state(Archive& archive);

 private:
  double over_;
  std::vector<double> drawn_;  // [m] (partners) deepest overlap of the references
  struct State {
    double begun = 0.0, begin = 0.0;        // 1: it has; [s] when
    std::vector<double> left, force, work;  // [m] [N] [J] (partners) after the last substep
  } state_;
};

}  // namespace abut
