// Momentum, as the scheme changes it by impulses.

#include "subdomain_solver/solid_interior.hpp"

#include <algorithm>
#include <array>

#include "subdomain_solver/time/momentum_lag.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

namespace {

/// Along axes of space in which constraints hold a node: these take a part of the impulses.
std::array<bool, 3> held_axes(const FeModel& model, const std::vector<HeldCoordinates>& all) {
  std::array<bool, 3> held{};
  const int dim = model.mesh().dim;
  for (const HeldCoordinates& constraint : all)
    for (const int dof : constraint.dofs)
      for (int i = 0; i < dim; ++i)
        held[i] = held[i] || model.frame(dof / dim) != nullptr || dof % dim == i;
  return held;
}

}  // namespace

/// To the momenta of the nodes, along the axes of space  [M.24].
void SolidInterior::add_lag() {
  const MomentumLag* lag = parts_.scheme.integrator->able().lag;
  if (!state_.begun || is_passive() || lag == nullptr) return;
  const Motion& motion = state_.motion;
  lag->find(motion, parts_.scheme.step, forces_now(), behind_);
  Vector& nodes = parts_.reduced ? nodes_behind_ : behind_;
  if (parts_.reduced) {
    lag_.resize(nodal_values());
    parts_.map->velocity(motion.q, span_of(behind_), lag_);  // modes have a mass of one
    nodes.noalias() = mass_ * view(lag_);
  }
  parts_.model->to_space({nodes.data(), nodal_values()});
  const std::array<bool, 3> held = held_axes(*parts_.model, parts_.constraints);
  const Eigen::Index dim = description_.dim;
  for (Eigen::Index k = 0; k < nodes.size(); ++k)
    if (!held[k % dim]) momentum_(k) += nodes(k);
}

/// [N] (coordinates) of loads, and of what acts on ports but for forces that accelerations do not
/// know: those are constant in steps, and pass whole.
const Vector& SolidInterior::forces_now() {
  change_.setZero(parts_.problem->model->dofs());
  for (const std::unique_ptr<Load>& load : parts_.problem->loads)
    if (load.get() != port_forces_) load->add(state_.time, state_.motion.q, change_);
  if (port_forces_ == nullptr) return change_;
  before_ = state_.port_force;
  const bool without_ties = parts_.scheme.integrator->able().accelerates_without_ties;
  for (std::size_t p = 0; without_ties && p < ports_.size(); ++p) {
    const auto first = before_.begin() + static_cast<std::ptrdiff_t>(port_map_->first(p));
    if (joined_[p]) std::fill_n(first, port_map_->width(p), 0.0);
  }
  port_map_->lift(state_.motion.q, before_, change_);
  return change_;
}

}  // namespace abut
