#include "subdomain_solver/bars/central_difference.hpp"

#include <algorithm>

#include "base/index.hpp"
#include "subdomain_solver/bars/bar_kernels.hpp"

namespace abut {

CentralDifference::CentralDifference(const Bar& bar, double step, int terms)
    : BarIntegrator(bar), step_(step), terms_(terms) {
  const double r = step_ / (bar_.spacing() / bar_.data().wave_speed());
  for (int q = 2; q <= terms_; ++q) {
    ratio_.push_back(((q - 1.0) * (q - 1.0) - r * r) / (2.0 * q * (2.0 * q - 1.0)));
  }
  const std::size_t n = index(bar_.nodes());
  const std::vector<double>& k = bar_.stiffness();
  const double cell = bar_.spacing() / bar_.data().wave_speed();
  for (std::size_t i : {std::size_t{0}, std::size_t{1}, n - 2, n - 1}) {
    const bool listed =
        std::any_of(outer_.begin(), outer_.end(), [i](const Row& row) { return row.node == i; });
    if (listed) continue;
    const double inverse = bar_.inverse_mass()[i];
    outer_.push_back({i, i > 0 ? i - 1 : i, i + 1 < n ? i + 1 : i, i > 0 ? k[i - 1] : 0.0,
                      i + 1 < n ? k[i] : 0.0, inverse, cell * cell * inverse});
  }
  for (int end : {0, 1}) {
    if (!is(end, ContactLayer::massless)) continue;
    End& e = ends_[end];
    e.spring = end == 0 ? bar_.stiffness().front() : bar_.stiffness().back();
    BarState unit;
    unit.u.assign(n, 0.0);
    unit.u[bar_.node_of(end)] = 1.0;
    unit.end[0].closed = unit.end[1].closed = true;
    const double* response = smooth(unit, unit.u, asked_[0]);
    e.response.assign(response, response + n);
    e.compliance = 1.0 / (e.spring * (1.0 - e.response[bar_.inner_of(end)]));
    if (end == 1) std::reverse(e.response.begin(), e.response.end());
    e.response.resize(std::min(n, index(terms_)));
  }
}

/// Returns u~ (nodes), one of the places.
double* CentralDifference::smooth(const BarState& state, const std::vector<double>& u,
                                  Smoothing& places) const {
  const std::size_t n = u.size();
  double* const a = placed_like(u.data(), n, places.a);
  double* const b = placed_like(u.data(), n, places.b);
  // A contact node is held by its partner: its row alone, without the contact force, is not what
  // moves it.
  std::array<std::size_t, 2> held;
  std::size_t holds = 0;
  for (int end : {0, 1}) {
    if (is(end, ContactLayer::kick) && state.end[end].closed)
      held[holds++] = index(bar_.node_of(end));
  }
  if (ratio_.empty()) std::copy(u.begin(), u.end(), a);
  const double* t = u.data();
  double* out = a;
  for (std::size_t pass = ratio_.size(); pass-- > 0;) {
    out = t == a ? b : a;
    if (n > 4) smooth_nodes(u.data(), t, out, 2, n - 2, ratio_[pass]);
    for (const Row& row : outer_)
      out[row.node] = u[row.node] + ratio_[pass] * (row.smoothing * row.force(t));
    for (std::size_t k = 0; k < holds; ++k) out[held[k]] = u[held[k]];
    t = out;
  }
  return out;
}

void CentralDifference::kick_end_nodes(BarState& state, const double* s, double kick) {
  for (const Row& row : outer_) {
    if (row.inverse_mass == 0.0) continue;
    state.v[row.node] += kick * (bar_.data().body_force - row.inverse_mass * row.force(s));
  }
  for (int end : {0, 1}) {
    if (!is(end, ContactLayer::massive)) continue;
    const std::size_t node = index(bar_.node_of(end));
    const double force = state.end[end].dynamic;
    state.v[node] -= kick * bar_.inverse_mass()[node] * Bar::outward(end) * force;
  }
}

void CentralDifference::drift_end_nodes(BarState& state, double dt) {
  for (const Row& row : outer_) {
    if (row.inverse_mass > 0.0) state.u[row.node] += dt * state.v[row.node];
  }
}

void CentralDifference::kick_drift(BarState& state, double kick, double dt) {
  const std::size_t n = state.u.size();
  const double g = kick * bar_.element_stiffness() / bar_.element_mass();
  const double shift = kick * bar_.data().body_force;
  const double* s = smoothed(state);
  if (viscous()) {
    viscous_.assign(n, 0.0);
    add_viscous_force(state.v, viscous_);
    for (std::size_t i = 0; i < n; ++i) state.v[i] -= kick * bar_.inverse_mass()[i] * viscous_[i];
  }
  if (forward()) acceleration(state, loads_.before);  // before the places move on
  const std::vector<double>& load = loads_.before;
  for (std::size_t i = 0; i < load.size(); ++i)
    state.v[i] += kick * bar_.inverse_mass()[i] * load[i];
  kick_end_nodes(state, s, kick);
  if (n > 4 && simple()) {
    kick_drift_nodes(state.u.data(), state.v.data(), 2, n - 2, g, shift, dt);
  } else if (n > 4) {
    kick_nodes(s, state.v.data(), 2, n - 2, g, shift);
    drift_nodes(state.u.data(), state.v.data(), 2, n - 2, dt);
  }
  drift_end_nodes(state, dt);
  push_on(state, kick, dt);
}

void CentralDifference::push_on(BarState& state, double kick, double dt) const {
  if (!forward()) return;
  const double weight = (bar_.data().tchamwa - 1.0) * kick * dt;
  for (std::size_t i = 0; i < state.u.size(); ++i) {
    if (bar_.inverse_mass()[i] > 0.0) state.u[i] += weight * state.a[i];
  }
}

void CentralDifference::add_viscous_force(const std::vector<double>& v,
                                          std::vector<double>& force) const {
  const double dashpot = bar_.data().bulk_viscosity * bar_.data().impedance();  // [kg/s]
  for (std::size_t e = 0; e + 1 < v.size(); ++e) {
    if (bar_.inverse_mass()[e] == 0.0 || bar_.inverse_mass()[e + 1] == 0.0) continue;
    const double tension = dashpot * (v[e + 1] - v[e]);
    force[e] -= tension;
    force[e + 1] += tension;
  }
}

void CentralDifference::drift(BarState& state, double dt) {
  const std::size_t n = state.u.size();
  if (n > 4) drift_nodes(state.u.data(), state.v.data(), 2, n - 2, dt);
  drift_end_nodes(state, dt);
}

void CentralDifference::acceleration(BarState& state, const std::vector<double>& load) {
  const double* s = smoothed(state);
  bar_.internal_force({s, state.u.size()}, force_);
  if (viscous()) add_viscous_force(state.v, force_);
  const std::vector<double>& inverse = bar_.inverse_mass();
  const double body_force = bar_.data().body_force;
  for (std::size_t i = 0; i < force_.size(); ++i) {
    state.a[i] = inverse[i] > 0.0 ? body_force - inverse[i] * force_[i] : 0.0;
  }
  for (std::size_t i = 0; i < load.size(); ++i) state.a[i] += inverse[i] * load[i];
  for (int end : {0, 1}) {
    const std::size_t node = index(bar_.node_of(end));
    const EndState& e = state.end[end];
    if (is(end, ContactLayer::massive))
      state.a[node] -= inverse[node] * Bar::outward(end) * e.dynamic;
    if (is(end, ContactLayer::massless)) state.a[node] = state.a[bar_.inner_of(end)];
  }
}

/// Compressive force [N] that keeps a massless end where it is.
double CentralDifference::reaction_of(const BarState& state, int end) const {
  const double* s = smoothed(state);
  const std::size_t node = index(bar_.node_of(end));
  const std::size_t inner = index(bar_.inner_of(end));
  const double internal = ends_[end].spring * Bar::outward(end) * (s[inner] - s[node]);
  return loads_.now.empty() ? internal : internal + Bar::outward(end) * loads_.now[node];
}

void CentralDifference::place_massless(BarState& state, int end, const EndAction& action,
                                       double dt) {
  const End& line = ends_[end];
  EndState& e = state.end[end];
  const double n = Bar::outward(end);
  const std::size_t node = index(bar_.node_of(end));
  const double before = n * state.u[node];
  const double free_position = before + line.compliance * reaction_of(state, end);
  if (action.kind == EndAction::Kind::obstacle) {
    e.force = e.dynamic = end_reaction(free_position, line.compliance, action);
  } else if (action.kind == EndAction::Kind::open) {
    e.force = e.dynamic = 0.0;
  } else {
    e.force = action.force;
    e.dynamic = action.dynamic;
  }
  const double shift = n * ((free_position - line.compliance * e.dynamic) - before);
  state.u[node] += shift;
  if (!simple()) {
    for (std::size_t i = 0; i < line.response.size(); ++i) {
      const std::size_t at = end == 0 ? i : state.u.size() - 1 - i;
      smoothed_[at] += shift * line.response[i];
    }
  }
  if (dt > 0.0) state.v[node] += shift / dt;  // backward difference: nothing but output reads it
}

void CentralDifference::resolve_massless(BarState& state, const EndActions& actions, double dt) {
  bool moved = false;
  for (int end : {0, 1}) {
    if (!is(end, ContactLayer::massless)) continue;
    moved = true;
    const EndAction& action = actions[end];
    const std::size_t node = index(bar_.node_of(end));
    const std::size_t inner = index(bar_.inner_of(end));
    const double before = state.u[node];
    if (action.kind == EndAction::Kind::open) {
      state.u[node] = state.u[inner];
    } else if (action.kind == EndAction::Kind::obstacle) {
      // the usual answer; corrected below when it is not
      state.u[node] = Bar::outward(end) * action.target;
    }
    if (dt > 0.0) state.v[node] = (state.u[node] - before) / dt;
  }
  if (!simple()) smoothed_ = smooth(state, state.u, present_);
  if (!moved) return;
  for (int end : {0, 1}) {
    const EndAction& action = actions[end];
    if (is(end, ContactLayer::massless)) place_massless(state, end, action, dt);
  }
}

void CentralDifference::resolve_kick(BarState& state, int end, const EndAction& action, double dt) {
  EndState& e = state.end[end];
  const std::size_t node = index(bar_.node_of(end));
  const double n = Bar::outward(end);
  const double inverse = bar_.inverse_mass()[node];
  if (action.kind == EndAction::Kind::obstacle) {
    e.force = end_reaction(n * state.u[node], dt * dt * inverse, action);
  } else {
    e.force = action.kind == EndAction::Kind::force ? action.dynamic : 0.0;
  }
  e.dynamic = e.force;
  state.v[node] -= n * dt * inverse * e.force;
  state.u[node] -= n * dt * dt * inverse * e.force;
  const double before = ends_[end].velocity_before;
  e.work -= dt * e.force * 0.5 * (before + n * state.v[node]);
  const bool held = action.held || e.force != 0.0;
  if (held == e.closed) return;
  e.work += simple() ? 0.0 : work_of_switch(state, end, dt);
  e.closed = held;
}

/// [J] by which [M.4] changes because a contact node comes to be held, or is no longer: its row
/// then smooths otherwise. With u before the substep and K d the change of the force after it,
/// 1/2 u K d.
double CentralDifference::work_of_switch(BarState& state, int end, double dt) const {
  EndState& e = state.end[end];
  const double* was = smooth(state, state.u, asked_[0]);
  e.closed = !e.closed;
  const double* is = smooth(state, state.u, asked_[1]);
  e.closed = !e.closed;
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < state.u.size(); ++i) {
    const double stretch = (state.u[i + 1] - state.u[i]) - dt * (state.v[i + 1] - state.v[i]);
    sum += bar_.stiffness()[i] * stretch * ((is[i + 1] - was[i + 1]) - (is[i] - was[i]));
  }
  return 0.5 * sum;
}

void CentralDifference::begin(BarState& state, const EndActions& actions) {
  resolve_massless(state, actions, 0.0);
  acceleration(state, loads_.now);
}

void CentralDifference::open(BarState& state, double dt, const EndActions& opening) {
  // Contact that comes or goes moves nothing by itself: a massless port that is free stands where
  // its force is zero. A force that sets in moves the port at once.
  bool refresh = false;
  for (int end : {0, 1}) {
    const EndAction& action = opening[end];
    if (!is(end, ContactLayer::massless) || action.kind == EndAction::Kind::obstacle) continue;
    const double force = action.kind == EndAction::Kind::force ? action.dynamic : 0.0;
    refresh = refresh || force != state.end[end].dynamic;
  }
  update_closed(state, opening);
  if (refresh) {
    EndActions held = opening;
    // an obstacle's reaction at this instant is the one already known
    for (std::size_t e : {0u, 1u}) {
      if (held[e].kind != EndAction::Kind::obstacle) continue;
      held[e].kind = EndAction::Kind::force;
      held[e].force = held[e].dynamic = state.end[e].dynamic;
    }
    resolve_massless(state, held, 0.0);
    acceleration(state, loads_.now);
  }
  for (int end : {0, 1}) {
    const std::size_t node = index(bar_.node_of(end));
    ends_[end].velocity_before =
        Bar::outward(end) * (state.v[node] - 0.5 * dt * state.a[node]);
  }
  kick_nodes_with(state, 0.5 * dt);
  previous_dt_ = 0.0;
  prescribed_ = {};
}

void CentralDifference::kick_nodes_with(BarState& state, double kick) const {
  const std::vector<double>& inverse = bar_.inverse_mass();
  for (std::size_t i = 0; i < state.v.size(); ++i) {
    if (inverse[i] > 0.0) state.v[i] += kick * state.a[i];
  }
}

void CentralDifference::substep(BarState& state, double dt, const EndActions& actions) {
  if (previous_dt_ == 0.0) {
    drift(state, dt);
    push_on(state, dt, dt);
  } else if (bar_.data().stabilised) {
    // the next predictor must not see the accelerations that close() drops
    close_under(state, previous_dt_, loads_.before);
    kick_nodes_with(state, 0.5 * dt);
    drift(state, dt);
    push_on(state, dt, dt);
  } else {
    for (int end : {0, 1}) {
      if (!is(end, ContactLayer::kick)) continue;
      const std::size_t node = index(bar_.node_of(end));
      ends_[end].velocity_before = Bar::outward(end) * state.v[node];
    }
    kick_drift(state, 0.5 * (previous_dt_ + dt), dt);
  }
  previous_dt_ = dt;
  for (int end : {0, 1}) {
    const EndAction& action = actions[end];
    if (is(end, ContactLayer::kick)) resolve_kick(state, end, action, dt);
    if (is(end, ContactLayer::massive)) resolve_massive(state, end, action);
  }
  // Last: it forms the smoothed displacements of the final places.
  resolve_massless(state, actions, dt);
}

void CentralDifference::resolve_massive(BarState& state, int end, const EndAction& action) {
  EndState& e = state.end[end];
  if (action.kind == EndAction::Kind::force) e.force = e.dynamic = action.force;
  if (action.kind != EndAction::Kind::motion) return;
  state.u[bar_.node_of(end)] = action.u;
  prescribed_[end] = action;
}

void CentralDifference::close(BarState& state, double dt) { close_under(state, dt, loads_.now); }

void CentralDifference::close_under(BarState& state, double dt, const std::vector<double>& load) {
  acceleration(state, load);
  kick_nodes_with(state, 0.5 * dt);
  for (int end : {0, 1}) {
    const std::size_t node = index(bar_.node_of(end));
    const EndAction& action = prescribed_[end];
    if (action.kind == EndAction::Kind::motion) {
      state.v[node] = action.v;
      state.a[node] = action.a;
    } else if (is(end, ContactLayer::massless) && !state.end[end].closed) {
      state.v[node] = state.v[bar_.inner_of(end)];
    }
    drop_acceleration(state, end);
  }
}

double CentralDifference::port_displacement(const BarState& state, int end) const {
  const EndState& e = state.end[end];
  const double u = state.u[bar_.node_of(end)];
  return u - Bar::outward(end) * static_compliance(end) * (e.force - e.dynamic);
}

double CentralDifference::static_compliance(int end) const { return ends_[end].compliance; }

double CentralDifference::kinetic(const BarState& state) const {
  const std::vector<double>& mass = bar_.row_mass();
  const std::vector<double>& inverse = bar_.inverse_mass();
  const double quarter = 0.25 * step_ * step_;
  double sum = 0.0;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    if (inverse[i] > 0.0)
      sum += mass[i] * (state.v[i] * state.v[i] - quarter * state.a[i] * state.a[i]);
  }
  return 0.5 * sum;
}

double CentralDifference::stored(const BarState& state) const {
  if (simple()) return bar_.stored(state.u);
  const double* s = smooth(state, state.u, asked_[0]);
  double sum = 0.0;
  for (std::size_t e = 0; e + 1 < state.u.size(); ++e) {
    sum += bar_.stiffness()[e] * (state.u[e + 1] - state.u[e]) * (s[e + 1] - s[e]);
  }
  return 0.5 * sum;
}

}  // namespace abut
