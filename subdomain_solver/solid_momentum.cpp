// Momentum, as the scheme changes it by impulses.

#include "subdomain_solver/solid_interior.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "base/dense.hpp"
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

/// The last step of a window may be shorter: it holds back another share of the impulses than what
/// is told, which is of the scheme's step. Rigid motions that no support holds take this share of
/// it [M.24]. What deforms stays as it is: stiff modes would gain up to the energy that they have.
void SolidInterior::shift_lag(double share) {
  if (share == 0.0 || parts_.scheme.integrator->able().lag == nullptr) return;
  std::vector<double>& v = state_.motion.v;
  if (parts_.reduced) {
    see_nodes();
    for (std::size_t k = 0; k < parts_.frequencies.size(); ++k)  // modes have a mass of one
      if (parts_.frequencies[k] == 0.0) v[k] += share * behind_(static_cast<Eigen::Index>(k));
    return;
  }
  const Eigen::MatrixXd motions = free_motions(true);
  if (motions.cols() == 0) return;
  const Vector lag = nodal_momentum() - mass_ * view(v);
  const Eigen::MatrixXd heavy = motions.transpose() * (mass_ * motions);
  const Vector moved = share * (motions.transpose() * lag);
  view(v) += motions * solve_symmetric(heavy, moved);
}

/// Where mass comes to lie further inside, a body has to turn faster, and its energy may not last
/// for that: fails where its angular momentum is another one now than that of the momentum [kg m/s]
/// that the nodes had, by more than a small part of all that they add to it.
std::optional<Failed> SolidInterior::turned_otherwise(const Vector& momentum, double time) {
  constexpr double small = 2.0e-3;
  if (parts_.reduced) return std::nullopt;
  const Eigen::MatrixXd motions = free_motions(true);
  const Vector missing = motions.transpose() * (momentum - nodal_momentum());
  const Vector all = motions.cwiseAbs().transpose() * momentum.cwiseAbs();
  if ((missing.cwiseAbs().array() <= small * all.array()).all()) return std::nullopt;
  return Failed{
      Failed::Cause::no_convergence, time,
      fmt::format("body '{}' would lose angular momentum by a change of form", description_.name)};
}

/// Forces of ties [N] (port values) that accelerations do not know become none: they are constant
/// in steps, and pass whole. Nodes without mass, where a tied side meets one that may touch, stand
/// where forces of the step before hold them, until the step moves them.
void SolidInterior::leave_out_unknown(std::vector<double>& forces) const {
  if (!parts_.scheme.integrator->able().accelerates_without_ties) return;
  for (std::size_t p = 0; p < ports_.size(); ++p)
    if (joined_[p])
      std::fill_n(forces.begin() + static_cast<std::ptrdiff_t>(port_map_->first(p)),
                  port_map_->width(p), 0.0);
}

/// [N] (coordinates) of loads, and of what acts on ports as far as accelerations know of it.
const Vector& SolidInterior::forces_now() {
  change_.setZero(parts_.problem->model->dofs());
  for (const std::unique_ptr<Load>& load : parts_.problem->loads)
    if (load.get() != port_forces_) load->add(state_.time, state_.motion.q, change_);
  if (port_forces_ == nullptr) return change_;
  before_ = state_.port_force;
  leave_out_unknown(before_);
  port_map_->lift(state_.motion.q, before_, change_);
  return change_;
}

}  // namespace abut
