#pragma once

#include <functional>
#include <vector>

#include "subdomain_solver/bars/bar.hpp"

namespace abut {

/// Forces on a bar besides those of its ports: on its ends, and per mass on all of it. They act on
/// nodes; what acts on the node of a massless port reaches the bar through its contact element.
class BarLoads {
 public:
  using OfTime = std::function<double(double)>;                  // of t [s]
  using OfPlaceAndTime = std::function<double(double, double)>;  // of reference x [m] and t [s]

  /// Forces per mass act by the row sums of the mass where `lumped`, and else by the scheme's
  /// mass matrix, as on solids. The mass of a contact element is that of its inner node either way.
  BarLoads(const Bar& bar, bool lumped);

  void push(int end, OfTime force);              // [N] along x
  void accelerate(OfPlaceAndTime acceleration);  // [m/s^2]
  bool empty() const { return pushes_.empty() && accelerations_.empty(); }

  /// Forces on the nodes at a time [N] (nodes), along x.
  void at(double time, std::vector<double>& force) const;

 private:
  struct Push {
    std::size_t node = 0;
    OfTime force;
  };

  std::vector<double> place_;         // [m] (nodes)
  std::vector<double> own_, beside_;  // [kg] diagonal (nodes) and beside it (elements or none)
  std::vector<Push> pushes_;
  std::vector<OfPlaceAndTime> accelerations_;
  mutable std::vector<double> acceleration_;  // [m/s^2] (nodes) scratch
};

}  // namespace abut
