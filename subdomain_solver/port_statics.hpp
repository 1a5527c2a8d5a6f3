#pragma once

#include <span>
#include <vector>

#include "subdomain_solver/port_map.hpp"
#include "subdomain_solver/time/quasi_static.hpp"

namespace abut {

/// How the ports of a solid without inertia answer, by its present tangent.
class PortStatics {
 public:
  /// All of the solid's, which must outlive it. `time`: [s] of the motion.
  PortStatics(const Motion& motion, const double& time, QuasiStatic& statics, const PortMap& map)
      : motion_(motion), time_(time), statics_(statics), map_(map) {}

  /// [N] of the last substep, along Description::loose motions.
  std::span<const double> unbalanced() const { return statics_.unbalanced(); }
  /// [m] by which a force [N] on the ports moves them (values of all ports), at places [m] of its
  /// loose motions, and what is left over along these [N]. The state is left untouched. False: the
  /// tangent has no inverse.
  [[nodiscard]] bool give(std::span<const double> force, const Vector& place,
                          std::vector<double>& moved, Vector& left);

 private:
  const Motion& motion_;
  const double& time_;
  QuasiStatic& statics_;
  const PortMap& map_;
  std::vector<double> force_;  // [N] (port values)
  Vector lifted_, moved_;      // [N], [m] (coordinates)
};

}  // namespace abut
