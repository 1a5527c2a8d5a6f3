// Where ports would be after a window, told without going there.

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "subdomain_solver/solid_interior.hpp"
#include "subdomain_solver/time/implicit_dynamics.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

/// Let go of, material with a history would unload at a joined port: implicit bodies take the way
/// there by Newton's method or by a tangent that is not that of loading, and neither saves a call.
bool SolidInterior::looks_ahead() const {
  return !joins_ || state_.motion.history.empty() || std::isfinite(description_.stable_step);
}

bool SolidInterior::peek(const Window& window, std::vector<double>& u) {
  const auto presses = [](const BoundaryData& on) {
    return std::ranges::any_of(on.forces, [](const Waveform& force) {
      return std::ranges::any_of(force.f, [](double f) { return f != 0.0; });
    });
  };
  if (!joins_ || contact_) return false;
  if (std::ranges::any_of(window.request.boundary, presses)) return false;
  port_forces_->impose(window.request.boundary, window.grid);
  port_forces_->enter(1);
  if (parts_.scheme.integrator->implicit() != nullptr) return go_on(window, u);
  if (window.grid.count > 1) return false;
  const double begin = window.grid.begin, dt = window.grid.length(1);
  if (!parts_.scheme.integrator->peek(state_.motion, begin, dt, peeked_)) return false;
  port_map_->displacement(peeked_, u);
  return true;
}

/// As the tangent at the begin has it.
bool SolidInterior::go_on(const Window& window, std::vector<double>& u) {
  ImplicitDynamics& dynamics = *parts_.scheme.integrator->implicit();
  const Motion& motion = state_.motion;
  const Substeps& grid = window.grid;
  ImplicitDynamics::Beside beside;
  u.resize(index(grid.count) * port_map_->values());
  for (int i = 1; i <= grid.count; ++i) {
    if (!dynamics.go_on(motion, grid.time(i - 1), grid.length(i), beside)) return false;
    peeked_ = motion.q;
    view(peeked_) += beside.u;
    port_map_->displacement(peeked_, before_);
    std::ranges::copy(before_, u.begin() + (i - 1) * static_cast<std::ptrdiff_t>(before_.size()));
  }
  return true;
}

}  // namespace abut
