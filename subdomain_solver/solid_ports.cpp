// What partners do to a solid through its ports: forces, impulses, and their work.

#include <algorithm>

#include "subdomain_solver/contact/surface_contact.hpp"
#include "subdomain_solver/solid_interior.hpp"
#include "subdomain_solver/time/inertia.hpp"

namespace abut {

/// Impulses on joined ports make velocities one at the start  [M.122].
void SolidInterior::set_off(const Window& window) {
  if (!description_.can.impulse) return;
  const std::vector<BoundaryData>& boundary = window.request.boundary;
  if (std::ranges::all_of(boundary, [](const BoundaryData& b) { return b.impulse.empty(); }))
    return;
  before_.assign(port_map_->values(), 0.0);
  for (std::size_t p = 0; p < boundary.size(); ++p)
    std::ranges::copy(boundary[p].impulse,
                      before_.begin() + static_cast<std::ptrdiff_t>(port_map_->first(p)));
  change_.setZero(parts_.problem->model->dofs());
  port_map_->lift(state_.motion.q, before_, change_);
  hand_on(change_);
  port_map_->velocity(state_.motion.q, state_.motion.v, now_);
  add_work_of_impulses();
  parts_.scheme.integrator->able().inertia->strike(state_.motion, change_);
  spread_velocities();
  port_map_->velocity(state_.motion.q, state_.motion.v, now_);
  add_work_of_impulses();
  for (const Prescribed& p : parts_.problem->supports)  // they withstand it, and go on as told
    state_.motion.external_work -= change_(p.dof) * state_.motion.v[p.dof];
}

/// Forces on ports begin and end between windows: accelerations follow at once, and ports without
/// mass. What presses on a port goes on pressing where the obstacle stays.
std::optional<Failed> SolidInterior::meet_port_forces(double time) {
  if (port_forces_ == nullptr) return std::nullopt;
  port_forces_->at(time, now_);
  if (contact_) contact_->hold(state_.port_force, now_);
  return take_port_forces(time);
}

/// Means over dual cells press on a surface whose partner has other levels. When the window ends it
/// stands where the force of the instant holds it  [M.127].
std::optional<Failed> SolidInterior::meet_end() {
  now_ = state_.port_force;
  if (port_forces_ == nullptr || !port_forces_->add_end(now_)) return std::nullopt;
  return take_port_forces(state_.time);
}

/// Those of now_, instead of those of the state.
std::optional<Failed> SolidInterior::take_port_forces(double time) {
  if (state_.begun && now_ != state_.port_force) {
    before_ = now_;
    for (std::size_t k = 0; k < now_.size(); ++k) before_[k] -= state_.port_force[k];
    leave_out_unknown(before_);
    change_.setZero(parts_.problem->model->dofs());
    port_map_->lift(state_.motion.q, before_, change_);
    if (contact_) port_map_->displacement(state_.motion.q, before_);
    Inertia* inertia = parts_.scheme.integrator->able().inertia;
    if (inertia != nullptr)
      if (auto failed = inertia->jump(state_.motion, time, change_)) return failed;
    if (contact_) {
      port_map_->displacement(state_.motion.q, places_);
      add_port_work();
    }
  }
  state_.port_force = now_;
  return std::nullopt;
}

/// Of the forces on ports, which change from those of the state to now_ while the ports move from
/// before_ to their places.
void SolidInterior::add_port_work() {
  for (std::size_t p = 0; p < worked_.size(); ++p) {
    const std::size_t first = port_map_->first(p), end = first + port_map_->width(p);
    for (std::size_t k = first; k < end; ++k) {
      const double work = 0.5 * (state_.port_force[k] + now_[k]) * (places_[k] - before_[k]);
      state_.port_work += work;
      worked_[p] += work;
    }
  }
}

/// Half of that of the impulses in before_, at the velocities in now_: before them, and after.
void SolidInterior::add_work_of_impulses() {
  for (std::size_t p = 0; p < worked_.size(); ++p) {
    const std::size_t first = port_map_->first(p), end = first + port_map_->width(p);
    for (std::size_t k = first; k < end; ++k) worked_[p] += 0.5 * before_[k] * now_[k];
  }
}

/// After a substep: where the ports are, and the work that the forces on them have done.
void SolidInterior::follow_ports(double time) {
  before_.swap(places_);
  port_map_->displacement(state_.motion.q, places_);
  const bool pressed = parts_.problem->contact != nullptr;
  port_forces_->leave(substep_, state_.light);
  if (!port_forces_->acts() && !pressed) return;
  port_forces_->at(time, now_);
  const auto pressed_in = [this] { return surfaces_ != nullptr ? surfaces_->pressed_in() : 0.0; };
  const double done = pressed_in();
  if (pressed) contact_->settle(now_);
  if (description_.quasi_static && surfaces_ != nullptr &&
      std::ranges::all_of(state_.port_force, [](double force) { return force == 0.0; }))
    state_.motion.external_work += surfaces_->taken_at_once();
  add_port_work();
  // What presses an overlap in is external work, and none that partners do.
  if (const double more = pressed_in() - done; more != 0.0)
    worked_[index(std::ranges::find(may_touch_, char{1}) - may_touch_.begin())] -= more;
  state_.port_force = now_;
}

}  // namespace abut
