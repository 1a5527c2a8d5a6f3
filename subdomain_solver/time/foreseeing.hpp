#pragma once

#include <vector>

#include "subdomain_solver/model.hpp"

namespace abut {

/// A motion's next steps as far as they have been told. Starts empty: at the motion itself.
struct Foreseen {
  std::vector<double> q;  // [m] (dofs) coordinates at the end of the last step that was told
  int steps = 0;          // how many were told
  Vector u, v;            // [m] beside the motion, [m/s] (dofs): of who tells by a tangent
};

/// Tells where a motion goes without taking it there: first guesses of partners.
class Foreseeing {
 public:
  /// One more step, under the problem's loads. False: only the step itself tells.
  [[nodiscard]] virtual bool foresee(const Motion& motion, double time, double dt,
                                     Foreseen& ahead) = 0;

 protected:
  ~Foreseeing() = default;
};

}  // namespace abut
