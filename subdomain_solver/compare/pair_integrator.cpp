#include "subdomain_solver/compare/pair_integrator.hpp"

#include <algorithm>

namespace abut {

void PairState::state(Archive& archive) {
  archive.field("u", u);
  archive.field("v", v);
  archive.field("a", a);
  archive.field("force", force);
}

// ---- explicit -----------------------------------------------------------------------------------

ExplicitPair::ExplicitPair(BarPair& pair, const PairContact& contact, double step, PairState& state)
    : PairIntegrator(pair, contact), step_(step) {
  accelerate(state, 0.5 * step, step);
}

/// `kick`: what an acceleration adds to the velocity that the next substep drifts with.
double ExplicitPair::contact_force(const PairState& state, double kick, double dt) const {
  if (!contact_.multiplier()) return contact_.penalty * std::max(0.0, -pair_.gap(state.u));
  const std::size_t left = pair_.tip(0);
  const std::size_t right = pair_.tip(1);
  const double opening =
      (state.v[right] + kick * state.a[right]) - (state.v[left] + kick * state.a[left]);
  const double next = pair_.gap(state.u) + dt * opening;
  const double mobility = 1.0 / pair_.mass()[left] + 1.0 / pair_.mass()[right];
  return std::max(0.0, -next / (dt * kick * mobility));
}

void ExplicitPair::accelerate(PairState& state, double kick, double dt) {
  pair_.internal_force(state.u, force_);
  for (std::size_t i = 0; i < force_.size(); ++i) state.a[i] = -force_[i] / pair_.mass()[i];
  state.force = contact_force(state, kick, dt);
  state.a[pair_.tip(0)] -= state.force / pair_.mass()[pair_.tip(0)];
  state.a[pair_.tip(1)] += state.force / pair_.mass()[pair_.tip(1)];
}

bool ExplicitPair::substep(PairState& state, double dt) {
  for (std::size_t i = 0; i < state.u.size(); ++i) {
    state.v[i] += 0.5 * dt * state.a[i];
    state.u[i] += dt * state.v[i];
  }
  if (!pair_.follow(state.u)) return false;
  accelerate(state, dt, dt);
  for (std::size_t i = 0; i < state.v.size(); ++i) state.v[i] += 0.5 * dt * state.a[i];
  return true;
}

double ExplicitPair::kinetic(const PairState& state, int member) const {
  return 0.5 * (pair_.mass_norm(member, state.v) -
                0.25 * step_ * step_ * pair_.mass_norm(member, state.a));
}

// ---- implicit -----------------------------------------------------------------------------------

ImplicitPair::ImplicitPair(BarPair& pair, const PairContact& contact, const StepWeights& weights)
    : PairIntegrator(pair, contact), w_(weights) {}

void ImplicitPair::factor(double dt) {
  if (dt == factored_dt_ && pair_.lengths() == ElementLengths::reference) return;
  factored_dt_ = dt;
  const double m = 1.0 / (w_.beta * dt * dt);
  const std::size_t n = pair_.nodes();
  std::vector<double> diagonal(n, 0.0);
  std::vector<double> beside(n - 1, 0.0);
  for (std::size_t i = 0; i < n; ++i) diagonal[i] = m * pair_.mass()[i];
  for (std::size_t e = 0; e + 1 < n; ++e) {
    diagonal[e] += pair_.stiffness()[e];
    diagonal[e + 1] += pair_.stiffness()[e];
    beside[e] = m * pair_.mass_beside()[e] - pair_.stiffness()[e];
  }
  matrix_.factor(diagonal, beside);
  column_.assign(n, 0.0);
  column_[pair_.tip(0)] = -1.0;
  column_[pair_.tip(1)] = 1.0;
  matrix_.solve(column_);
}

bool ImplicitPair::substep(PairState& state, double dt) {
  if (!pair_.follow(state.u)) return false;
  factor(dt);
  const std::size_t n = state.u.size();
  const double m = 1.0 / (w_.beta * dt * dt);
  predicted_.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    predicted_[i] = dt * state.v[i] + dt * dt * w_.past * state.a[i];
  pair_.apply_mass(predicted_, increment_);
  pair_.internal_force(state.u, work_);
  for (std::size_t i = 0; i < n; ++i) increment_[i] = m * increment_[i] - work_[i];
  matrix_.solve(increment_);

  const std::size_t left = pair_.tip(0);
  const std::size_t right = pair_.tip(1);
  const double open_gap = pair_.gap(state.u) + (increment_[right] - increment_[left]);
  const double compliance = column_[right] - column_[left] + contact_.compliance();
  state.force = std::max(0.0, -open_gap / compliance);
  for (std::size_t i = 0; i < n; ++i) {
    increment_[i] += state.force * column_[i];
    const double a = m * (increment_[i] - predicted_[i]);
    state.v[i] += dt * ((1.0 - w_.gamma) * state.a[i] + w_.gamma * a);
    state.a[i] = a;
    state.u[i] += increment_[i];
  }
  return true;
}

double ImplicitPair::kinetic(const PairState& state, int member) const {
  return 0.5 * pair_.mass_norm(member, state.v);
}

}  // namespace abut
