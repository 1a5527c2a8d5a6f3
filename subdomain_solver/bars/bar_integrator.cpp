#include "subdomain_solver/bars/bar_integrator.hpp"
#include "base/index.hpp"

#include <algorithm>

namespace abut {

void EndState::state(Archive& archive) {
  archive.field("closed", closed);
  archive.field("force", force);
  archive.field("dynamic", dynamic);
}

void BarState::state(Archive& archive) {
  archive.field("u", u);
  archive.field("v", v);
  archive.field("a", a);
  for (EndState& e : end) e.state(archive);
}

std::size_t BarIntegrator::struck(int end) const {
  const std::size_t node = index(bar_.node_of(end));
  return bar_.inverse_mass()[node] > 0.0 ? node : index(bar_.inner_of(end));
}

void BarIntegrator::strike(BarState& state, int end, double impulse) const {
  const std::size_t at = struck(end);
  const double before = state.v[at];
  const std::vector<double>& unit = blow(end);
  if (unit.empty()) {
    state.v[at] += bar_.inverse_mass()[at] * impulse;
  } else {
    for (std::size_t i = 0; i < unit.size(); ++i) state.v[i] += impulse * unit[i];
  }
  state.end[end].work += impulse * 0.5 * (before + state.v[at]);
}

Recoil BarIntegrator::recoil(const BarState& state, int end) const {
  const std::size_t at = struck(end);
  const std::vector<double>& unit = blow(end);
  return {Bar::outward(end) * state.v[at], unit.empty() ? bar_.inverse_mass()[at] : unit[at]};
}

double BarIntegrator::internal_force(const BarState& state, int end) const {
  const std::size_t node = index(bar_.node_of(end));
  const std::size_t inner = index(bar_.inner_of(end));
  const double k = end == 0 ? bar_.stiffness().front() : bar_.stiffness().back();
  return k * (state.u[node] - state.u[inner]);
}

bool BarIntegrator::update_closed(BarState& state, const EndActions& actions) const {
  bool changed = false;
  for (std::size_t e : {0u, 1u}) {
    if (is(static_cast<int>(e), ContactLayer::kick)) continue;  // every kick tells for itself
    const bool closed = actions[e].kind != EndAction::Kind::open;
    if (closed == state.end[e].closed) continue;
    state.end[e].closed = closed;
    if (is(static_cast<int>(e), ContactLayer::massless)) continue;
    state.end[e].force = 0.0;
    state.end[e].dynamic = 0.0;
    changed = true;
  }
  return changed;
}

double end_reaction(double free_position, double compliance, const EndAction& action) {
  const double overlap = free_position - action.target;
  const double reaction = action.yield > 0.0 ? (action.dynamic + action.yield * overlap) /
                                                   (1.0 + action.yield * compliance)
                                             : overlap / (compliance + action.give);
  return action.bilateral ? reaction : std::max(0.0, reaction);
}

}  // namespace abut
