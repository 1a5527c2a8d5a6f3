#pragma once

#include <optional>

#include "contract/outcome.hpp"
#include "subdomain_solver/time/problem.hpp"

namespace abut {

/// How forces and impulses between steps change a motion that has inertia.
class Inertia {
 public:
  /// A load sets in or ends at the present time and changes the force by this much [N] (dofs):
  /// accelerations follow at once, and so do coordinates without mass. Schemes that keep neither
  /// have nothing to do. Forces that accelerations do not know are no part of it.
  [[nodiscard]] virtual std::optional<Failed> jump(Motion& motion, double time,
                                                   const Vector& change) = 0;
  /// An impulse [N s] (dofs) changes the velocities of free coordinates that have mass, and nothing
  /// else.
  virtual void strike(Motion& motion, const Vector& impulse) = 0;

 protected:
  ~Inertia() = default;
};

}  // namespace abut
