#pragma once

#include <vector>

#include "subdomain_solver/interior.hpp"
#include "subdomain_solver/port_forces.hpp"
#include "subdomain_solver/port_map.hpp"
#include "subdomain_solver/time/foreseeing.hpp"

namespace abut {

/// Where the ports of a tied solid go after a window, told without going there.
class PortForecast {
 public:
  /// All of the solid's, which must outlive it.
  PortForecast(const Motion& motion, Foreseeing& steps, const PortMap& map, PortForces& forces)
      : motion_(motion), steps_(steps), map_(map), forces_(forces) {}

  /// Displacements (substeps, values of all ports) [m] at the ends of the substeps of a window in
  /// which partners press with nothing. False: only a walk tells them.
  [[nodiscard]] bool tell(const Window& window, std::vector<double>& u);

 private:
  const Motion& motion_;
  Foreseeing& steps_;
  const PortMap& map_;
  PortForces& forces_;
  Foreseen ahead_;
  std::vector<double> places_;  // [m] (port values)
};

}  // namespace abut
