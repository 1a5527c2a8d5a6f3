#include "subdomain_solver/time/bar_integrator.hpp"

#include <algorithm>

namespace abut {

void EndState::state(Archive& archive) {
  archive.field("closed", closed);
  archive.field("force", force);
  archive.field("dynamic", dynamic);
  archive.field("captured", captured);
}

void BarState::state(Archive& archive) {
  archive.field("u", u);
  archive.field("v", v);
  archive.field("a", a);
  for (EndState& e : end) e.state(archive);
}

double BarIntegrator::internal_force(const BarState& state, int end) const {
  const std::size_t node = static_cast<std::size_t>(bar_.node_of(end));
  const std::size_t inner = static_cast<std::size_t>(bar_.inner_of(end));
  const double k = end == 0 ? bar_.stiffness().front() : bar_.stiffness().back();
  return k * (state.u[node] - state.u[inner]);
}

bool BarIntegrator::update_closed(BarState& state, const EndActions& actions) const {
  bool changed = false;
  for (std::size_t e : {0u, 1u}) {
    const bool closed = actions[e].kind != EndAction::Kind::open;
    if (closed == state.end[e].closed) continue;
    state.end[e].closed = closed;
    state.end[e].force = 0.0;
    state.end[e].dynamic = 0.0;
    if (closed) state.end[e].captured = 0.0;
    changed = true;
  }
  return changed;
}

double end_reaction(double free_position, double compliance, const EndAction& action) {
  const double overlap = free_position - action.target;
  const double reaction =
      action.yield > 0.0
          ? (action.dynamic + action.yield * overlap) / (1.0 + action.yield * compliance)
          : overlap / compliance;
  return action.bilateral ? reaction : std::max(0.0, reaction);
}

}  // namespace abut
