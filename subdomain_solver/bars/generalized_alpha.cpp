#include "subdomain_solver/bars/generalized_alpha.hpp"
#include "base/index.hpp"

#include <algorithm>

namespace abut {

GeneralizedAlpha::GeneralizedAlpha(const Bar& bar, const AlphaWeights& weights, double step)
    : BarIntegrator(bar), w_(weights), step_(step) {
  // Mass matrix with the rows that have no mass of their own, or are held, taken out.
  std::vector<double> diagonal = bar_.mass();
  std::vector<double> beside = bar_.mass_beside();
  for (std::size_t i = 0; i < diagonal.size(); ++i) {
    if (bar_.inverse_mass()[i] > 0.0) continue;
    diagonal[i] = 1.0;
    if (i > 0) beside[i - 1] = 0.0;
    if (i < beside.size()) beside[i] = 0.0;
  }
  mass_matrix_.factor(diagonal, beside);
  for (int end : {0, 1}) {
    const bool shared = is(end, ContactLayer::shared);
    if (!shared && !is(end, ContactLayer::massless)) continue;
    std::vector<double>& column = mass_column_[end];
    column.assign(diagonal.size(), 0.0);
    // a massless end passes its force on
    column[shared ? bar_.node_of(end) : bar_.inner_of(end)] = 1.0;
    mass_matrix_.solve(column);
  }
}

bool GeneralizedAlpha::held(int end, const EndActions& actions) const {
  return bar_.data().fixed[end] || actions[end].kind == EndAction::Kind::motion;
}

void GeneralizedAlpha::factor(double dt, const EndActions& actions) {
  const std::array<bool, 2> now = {held(0, actions), held(1, actions)};
  if (dt == factored_dt_ && now == factored_held_) return;
  factored_dt_ = dt;
  factored_held_ = now;
  const std::size_t n = index(bar_.nodes());
  const double m = (1.0 - w_.alpha_m) / (w_.beta * dt * dt);
  const double k = 1.0 - w_.alpha_f;
  std::vector<double> diagonal(n, 0.0);
  std::vector<double> beside(n - 1, 0.0);
  for (std::size_t e = 0; e + 1 < n; ++e) {
    const double stiffness = k * bar_.stiffness()[e];
    diagonal[e] += stiffness;
    diagonal[e + 1] += stiffness;
    beside[e] = m * bar_.mass_beside()[e] - stiffness;
  }
  for (std::size_t i = 0; i < n; ++i) diagonal[i] += m * bar_.mass()[i];
  for (int end : {0, 1}) {  // a held end is known: its row becomes the identity
    if (!now[end]) continue;
    diagonal[bar_.node_of(end)] = 1.0;
    beside[end == 0 ? 0 : n - 2] = 0.0;
  }
  matrix_.factor(diagonal, beside);
  for (int end : {0, 1}) {
    std::vector<double>& column = column_[end];
    column.assign(n, 0.0);
    column[bar_.node_of(end)] = k;
    matrix_.solve(column);
  }
}

void GeneralizedAlpha::apply_mass(const std::vector<double>& x, std::vector<double>& out) const {
  const std::size_t n = x.size();
  out.resize(n);
  for (std::size_t i = 0; i < n; ++i) out[i] = bar_.mass()[i] * x[i];
  if (bar_.lumped()) return;
  for (std::size_t e = 0; e + 1 < n; ++e) {
    out[e] += bar_.mass_beside()[e] * x[e + 1];
    out[e + 1] += bar_.mass_beside()[e] * x[e];
  }
}

void GeneralizedAlpha::initial_acceleration(BarState& state) const {
  bar_.internal_force(state.u, state.a);
  for (std::size_t i = 0; i < state.a.size(); ++i) {
    state.a[i] = bar_.row_mass()[i] * bar_.data().body_force - state.a[i];
  }
  for (std::size_t i = 0; i < loads_.now.size(); ++i) state.a[i] += loads_.now[i];
  for (int end : {0, 1}) {
    const std::size_t node = index(bar_.node_of(end));
    // a closed massless end is in balance with its force: nothing is left over there
    if (is(end, ContactLayer::massless)) state.a[node] = 0.0;
    if (is(end, ContactLayer::shared))
      state.a[node] -= Bar::outward(end) * state.end[end].dynamic;
  }
  for (std::size_t i = 0; i < state.a.size(); ++i) {
    if (bar_.inverse_mass()[i] == 0.0) state.a[i] = 0.0;
  }
  mass_matrix_.solve(state.a);
}

void GeneralizedAlpha::begin(BarState& state, const EndActions& actions) {
  for (int end : {0, 1}) {
    if (!is(end, ContactLayer::massless)) continue;
    const std::size_t node = index(bar_.node_of(end));
    const EndAction& action = actions[end];
    const double n = Bar::outward(end), compliance = static_compliance(end);
    double free_position = n * state.u[bar_.inner_of(end)];
    if (!loads_.now.empty()) free_position += n * compliance * loads_.now[node];
    EndState& e = state.end[end];
    const bool pressed = action.kind == EndAction::Kind::obstacle;
    e.force = e.dynamic = pressed ? end_reaction(free_position, compliance, action) : 0.0;
    state.u[node] = n * (free_position - compliance * e.dynamic);
  }
  initial_acceleration(state);
}

void GeneralizedAlpha::open(BarState& state, double, const EndActions& opening) {
  const bool changed = update_closed(state, opening);
  for (int end : {0, 1}) {
    if (!is(end, ContactLayer::massless) && !is(end, ContactLayer::shared)) continue;
    const std::size_t e = index(end);
    const std::size_t node = index(bar_.node_of(end));
    EndState& s = state.end[e];
    if (opening[e].kind == EndAction::Kind::obstacle) continue;
    const bool pushed = opening[e].kind == EndAction::Kind::force;
    const double force = pushed ? opening[e].dynamic : 0.0;
    if (force != s.dynamic) {
      const double jump = -Bar::outward(end) * (force - s.dynamic);
      for (std::size_t i = 0; i < state.a.size(); ++i) state.a[i] += jump * mass_column_[e][i];
      state.u[node] += jump * static_compliance(end);
    }
    s.force = pushed ? opening[e].force : 0.0;
    s.dynamic = force;
  }
  // Contact on a massless end comes and goes without a jump; accelerations are memory of the scheme
  // and stay.
  const bool massless = !is(0, ContactLayer::massive) && !is(1, ContactLayer::massive) &&
                        !is(0, ContactLayer::shared) && !is(1, ContactLayer::shared);
  if (changed && !massless) initial_acceleration(state);
}

void GeneralizedAlpha::right_hand_side(const BarState& state, double dt,
                                       const EndActions& actions) {
  const std::size_t n = state.u.size();
  predicted_.resize(n);
  trial_.resize(n);
  const double m = (1.0 - w_.alpha_m) / (w_.beta * dt * dt);
  for (std::size_t i = 0; i < n; ++i) {
    predicted_[i] = dt * state.v[i] + dt * dt * (0.5 - w_.beta) * state.a[i];
    trial_[i] = m * predicted_[i] - w_.alpha_m * state.a[i];
  }
  apply_mass(trial_, rhs_);
  const double body_force = bar_.data().body_force;
  if (body_force != 0.0) {
    for (std::size_t i = 0; i < n; ++i) rhs_[i] += bar_.row_mass()[i] * body_force;
  }
  const double late = 1.0 - w_.alpha_f;
  for (std::size_t i = 0; i < loads_.now.size(); ++i)
    rhs_[i] += late * loads_.now[i] + w_.alpha_f * loads_.before[i];
  bar_.internal_force(state.u, work_);
  for (std::size_t i = 0; i < n; ++i) rhs_[i] -= work_[i];
  for (int end : {0, 1}) {
    const std::size_t e = index(end);
    const double known = actions[e].kind == EndAction::Kind::force ? actions[e].dynamic : 0.0;
    const std::size_t node = index(bar_.node_of(end));
    // As published, and as HHT-alpha had it first: massive nodes take the force of the step's end.
    const double before = is(end, ContactLayer::massive) ? known : state.end[e].dynamic;
    rhs_[node] -= Bar::outward(end) * ((1.0 - w_.alpha_f) * known + w_.alpha_f * before);
  }
  for (int end : {0, 1}) {
    if (!held(end, actions)) continue;
    const std::size_t node = index(bar_.node_of(end));
    const std::size_t inner = index(bar_.inner_of(end));
    const EndAction& action = actions[end];
    const double move = action.kind == EndAction::Kind::motion ? action.u - state.u[node] : 0.0;
    const std::size_t element = end == 0 ? 0 : n - 2;
    rhs_[inner] -=
        (m * bar_.mass_beside()[element] - (1.0 - w_.alpha_f) * bar_.stiffness()[element]) * move;
    rhs_[node] = move;
  }
}

void GeneralizedAlpha::apply_reactions(const EndActions& actions, BarState& state) {
  // trial_ holds increments.
  // Both ends may be kinematic at once; their reactions are coupled through the body. Alternating
  // between them contracts by the square of the (small) coupling, so a few rounds reach round-off.
  std::array<double, 2> reaction = {0.0, 0.0};
  std::array<bool, 2> unknown = {actions[0].kind == EndAction::Kind::obstacle,
                                 actions[1].kind == EndAction::Kind::obstacle};
  const int rounds = unknown[0] && unknown[1] ? 50 : 1;
  for (int round = 0; round < rounds; ++round) {
    for (int end : {0, 1}) {
      const std::size_t e = index(end);
      if (!unknown[e]) continue;
      const std::size_t node = index(bar_.node_of(end));
      const double n = Bar::outward(end);
      const double compliance = column_[e][node];
      const double free_position = n * (state.u[node] + trial_[node]) + compliance * reaction[e];
      const double next = end_reaction(free_position, compliance, actions[e]);
      const double change = next - reaction[e];
      if (change == 0.0) continue;
      for (std::size_t i = 0; i < trial_.size(); ++i) trial_[i] -= n * change * column_[e][i];
      reaction[e] = next;
    }
  }
  for (std::size_t e : {0u, 1u}) {
    EndState& s = state.end[e];
    if (unknown[e]) s.force = s.dynamic = reaction[e];
    if (actions[e].kind == EndAction::Kind::force) {
      s.force = actions[e].force;
      s.dynamic = actions[e].dynamic;
    }
    if (actions[e].kind == EndAction::Kind::open) s.force = s.dynamic = 0.0;
  }
}

double GeneralizedAlpha::momentum_lag(const BarState& state) const {
  return step_ * lag_per_step(state, loads_.now);
}

/// [N] The momentum that is behind the impulses of the forces, over the step  [M.24]; under loads
/// [N] (nodes).
double GeneralizedAlpha::lag_per_step(const BarState& state,
                                      const std::vector<double>& loads) const {
  // Nodes that are held take part of the forces; massive contact nodes weigh theirs otherwise.
  for (int end : {0, 1}) {
    const bool fixed = bar_.data().fixed[end];
    if (fixed || is(end, ContactLayer::massive)) return 0.0;
  }
  double unbalanced = bar_.momentum(state.a) - bar_.data().body_force * bar_.data().mass_total();
  for (const double load : loads) unbalanced -= load;
  for (int end : {0, 1}) unbalanced += Bar::outward(end) * state.end[end].dynamic;
  return (0.5 - w_.alpha_f) * unbalanced;
}

/// Momentum is told with what the scheme's own step holds back; a shorter one holds back less.
/// `step` [s]: by how much, less than 0: back again. The body moves as one by the difference: what
/// deforms stays as it is.
void GeneralizedAlpha::shift_lag(BarState& state, const std::vector<double>& loads,
                                 double step) const {
  const double change = step * lag_per_step(state, loads) / bar_.data().mass_total();
  for (double& v : state.v) v += change;
}

void GeneralizedAlpha::advance_rates(BarState& state, double dt, const EndActions& actions) {
  const double inverse = 1.0 / (w_.beta * dt * dt);
  for (int end : {0, 1}) {  // output only: a massless end's own rates move nothing
    if (!is(end, ContactLayer::massless)) continue;
    const std::size_t node = index(bar_.node_of(end));
    predicted_[node] = trial_[node];
    state.v[node] = trial_[node] / dt;
    state.a[node] = 0.0;
  }
  for (std::size_t i = 0; i < trial_.size(); ++i) {
    const double a = inverse * (trial_[i] - predicted_[i]);
    state.v[i] += dt * ((1.0 - w_.gamma) * state.a[i] + w_.gamma * a);
    state.a[i] = a;
    state.u[i] += trial_[i];
  }
  for (int end : {0, 1}) {
    if (!held(end, actions)) continue;
    const std::size_t node = index(bar_.node_of(end));
    const EndAction& action = actions[end];
    const bool moving = action.kind == EndAction::Kind::motion;
    state.v[node] = moving ? action.v : 0.0;
    state.a[node] = moving ? action.a : 0.0;
  }
  for (int end : {0, 1}) drop_acceleration(state, end);
}

void GeneralizedAlpha::substep(BarState& state, double dt, const EndActions& actions) {
  factor(dt, actions);
  if (dt != step_) shift_lag(state, loads_.before, step_ - dt);
  right_hand_side(state, dt, actions);
  trial_ = rhs_;
  matrix_.solve(trial_);
  apply_reactions(actions, state);
  advance_rates(state, dt, actions);
  if (dt != step_) shift_lag(state, loads_.now, dt - step_);
}

void GeneralizedAlpha::close(BarState& state, double) {
  for (int end : {0, 1}) {  // output only: an open massless end moves with its inner node
    if (!is(end, ContactLayer::massless) || state.end[end].closed) continue;
    const std::size_t node = index(bar_.node_of(end));
    state.v[node] = state.v[bar_.inner_of(end)];
  }
}

double GeneralizedAlpha::port_displacement(const BarState& state, int end) const {
  const EndState& e = state.end[end];
  const double u = state.u[bar_.node_of(end)];
  return u - Bar::outward(end) * static_compliance(end) * (e.force - e.dynamic);
}

double GeneralizedAlpha::static_compliance(int end) const {
  if (!is(end, ContactLayer::massless)) return 0.0;
  return 1.0 / (end == 0 ? bar_.stiffness().front() : bar_.stiffness().back());
}

}  // namespace abut
