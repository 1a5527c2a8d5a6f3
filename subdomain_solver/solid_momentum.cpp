// Momentum, as the scheme changes it by impulses.

#include "subdomain_solver/solid_interior.hpp"

#include <algorithm>

#include "base/index.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

/// Of the nodes, in their frames  [M.24].
void SolidInterior::see_momentum() {
  momentum_.noalias() = mass_ * view(v_);
  const Integrator& integrator = *parts_.scheme.integrator;
  if (!state_.begun || !integrator.lags()) return;
  const Motion& motion = state_.motion;
  integrator.find_lag(motion, parts_.scheme.step, forces_now(), behind_);
  if (!parts_.reduced) {
    momentum_ += behind_;
    return;
  }
  lag_.resize(nodal_values());
  parts_.map->velocity(motion.q, span_of(behind_), lag_);  // modes have a mass of one
  momentum_.noalias() += mass_ * view(lag_);
}

/// [N] (coordinates) of loads, and of what acts on ports but for forces that accelerations do not
/// know: those are constant in steps, and pass whole.
const Vector& SolidInterior::forces_now() {
  change_.setZero(parts_.problem->model->dofs());
  for (const std::unique_ptr<Load>& load : parts_.problem->loads)
    if (load.get() != port_forces_) load->add(state_.time, state_.motion.q, change_);
  if (port_forces_ == nullptr) return change_;
  before_ = state_.port_force;
  for (std::size_t p = 0; parts_.scheme.integrator->joins_steadily() && p < ports_.size(); ++p) {
    const auto first = before_.begin() + static_cast<std::ptrdiff_t>(port_map_->first(p));
    if (joined_[p]) std::fill_n(first, port_map_->width(p), 0.0);
  }
  port_map_->lift(state_.motion.q, before_, change_);
  return change_;
}

}  // namespace abut
