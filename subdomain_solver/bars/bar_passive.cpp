// The passive form of a bar [M.128]: all mass on the nodes, and the way to and from its own scheme
// [M.130].

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/index.hpp"
#include "subdomain_solver/bars/bar_interior.hpp"
#include "subdomain_solver/bars/compressed_bar.hpp"

namespace abut {

namespace {
constexpr double may_gain = 1.0e-6;  // of its energy, by a change of form
constexpr double rounding = 1.0e-14;
constexpr double most_scaled = 2.0;  // of velocities: what is left of hardly any is noise
}  // namespace

double BarInterior::energy() const {
  const double moving =
      is_passive() ? midpoint_->kinetic(state_.v) : scheme_.integrator->kinetic(state_);
  return moving + (is_passive() ? bar_->stored(state_.u) : scheme_.integrator->stored(state_));
}

/// Velocities beside the motion of the centre, which stays, are scaled until the energy [J] is what
/// it was, and no more.
void BarInterior::keep_energy(double before) {
  // Masses of a scheme need not be those of the nodes: in turns.
  for (int k = 0; k < 30 && energy() < (1.0 - rounding) * before; ++k)
    take_from_deformation(energy() - before);
  for (int k = 0; k < 3; ++k) {
    const double excess = energy() - before;
    if (!(excess > 0.0) || !(take_from_deformation(excess) > 0.0)) return;
  }
}

/// Nothing presses on the ends; those of ties that take kicks stay held.
void BarInterior::let_go() {
  for (EndState& end : state_.end) end = EndState{};
  for (std::size_t p = 0; p < ends_.size(); ++p)
    if (description_.ports[p].tied && bar_->data().layer[index(ends_[p])] == ContactLayer::kick)
      state_.end[index(ends_[p])].closed = true;
}

/// A run may be resumed in the midst of the passive way.
void BarInterior::restored() {
  if (is_passive() && midpoint_ == nullptr) midpoint_ = std::make_unique<BarMidpoint>(*bar_);
}

double BarInterior::enter() {
  if (is_passive()) return 0.0;
  if (midpoint_ == nullptr) midpoint_ = std::make_unique<BarMidpoint>(*bar_);
  const double before = energy();
  const double behind = begun_ ? scheme_.integrator->momentum_lag(state_) : 0.0;
  std::array<double, 2> own{}, seen{};  // [m] of the ends: in the scheme's energy, by partners
  for (const int end : {0, 1}) {
    const std::size_t node = index(bar_->node_of(end));
    own[index(end)] = state_.u[node];
    seen[index(end)] = scheme_.integrator->port_displacement(state_, end);
    // its mass was the inner node's
    if (bar_->row_mass()[node] == 0.0 && !bar_->data().fixed[end])
      state_.v[node] = state_.v[index(bar_->inner_of(end))];
  }
  let_go();
  begun_ = true;
  state_.a.clear();
  const auto put = [&](double share) {
    for (const int end : {0, 1})
      state_.u[index(bar_->node_of(end))] = std::lerp(own[index(end)], seen[index(end)], share);
  };
  put(1.0);
  if (energy() > (1.0 + may_gain) * before) {
    double low = 0.0, high = 1.0;
    for (int k = 0; k < 30; ++k) {
      const double middle = 0.5 * (low + high);
      put(middle);
      (energy() > before ? high : low) = middle;
    }
    put(low);
  }
  if (behind != 0.0)  // what the scheme held back [M.24]; told, and the passive form has no such
    for (double& v : state_.v) v += behind / bar_->data().mass_total();
  keep_energy(before);
  return before - energy();
}

double BarInterior::damp(double joules) {
  return joules > 0.0 ? take_from_deformation(joules) : 0.0;
}

/// Below zero it is given.
double BarInterior::take_from_deformation(double joules) {
  const std::vector<double>& mass = is_passive() ? midpoint_->mass() : bar_->row_mass();
  const bool held = bar_->data().fixed[0] || bar_->data().fixed[1];
  double whole = 0.0, momentum = 0.0;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    whole += mass[i];
    momentum += mass[i] * state_.v[i];
  }
  const double mean = held ? 0.0 : momentum / whole;
  double most = 0.0;
  for (std::size_t i = 0; i < mass.size(); ++i)
    most += 0.5 * mass[i] * (state_.v[i] - mean) * (state_.v[i] - mean);
  if (!(most > 0.0)) return 0.0;
  const double before = energy(),
               kept = std::min(std::sqrt(std::max(0.0, 1.0 - joules / most)), most_scaled);
  for (std::size_t i = 0; i < mass.size(); ++i)
    if (mass[i] > 0.0) state_.v[i] = mean + kept * (state_.v[i] - mean);
  return before - energy();
}

std::optional<Failed> BarInterior::leave(double time, double& lost) {
  lost = 0.0;
  if (!is_passive()) return std::nullopt;
  const BarState passive = state_;
  const double work_before = load_work_;
  double present = energy();
  for (const int end : {0, 1}) {
    const std::size_t node = index(bar_->node_of(end)), inner = index(bar_->inner_of(end));
    if (bar_->row_mass()[node] > 0.0 || bar_->data().fixed[end]) continue;
    const double own = midpoint_->mass()[node], whole = bar_->row_mass()[inner];
    // of a bar of two elements both ends give their mass to one node
    state_.v[inner] += own / whole * (passive.v[node] - passive.v[inner]);
  }
  state_.a.assign(state_.u.size(), 0.0);
  let_go();
  if (loads_ != nullptr) meet_loads(time);
  const std::vector<double> before = state_.u;
  scheme_.integrator->begin(state_, {});
  if (loads_ != nullptr) {
    double work = 0.0;
    for (std::size_t i = 0; i < before.size(); ++i)
      work += scheme_.integrator->loads().now[i] * (state_.u[i] - before[i]);
    load_work_ += work;
    present += work;
  }
  keep_energy(present);
  lost = present - energy();
  if (-lost <= may_gain * present) return std::nullopt;
  // Schemes with other stiffnesses store more in the same strains than what deforms can pay.
  state_ = passive;
  load_work_ = work_before;
  return Failed{Failed::Cause::no_convergence, time,
                fmt::format("body '{}' would gain energy by a change of form", description_.name)};
}

/// Loads are means of those at both ends of the step.
void BarInterior::pass_loads(const PassiveStep& step, std::vector<double>& force) {
  force.assign(state_.u.size(), 0.0);
  if (loads_ != nullptr) {
    std::vector<double> now;
    loads_->at(step.begin, force);
    loads_->at(step.end, now);
    for (std::size_t i = 0; i < force.size(); ++i) force[i] = 0.5 * (force[i] + now[i]);
  }
}

std::optional<Failed> BarInterior::pass(const PassiveStep& step, PassiveReply& reply) {
  const bool moves = step.length() > 0.0;
  std::array<double, 2> impulse{0.0, 0.0};
  for (std::size_t p = 0; p < step.impulses.size(); ++p)
    if (!step.impulses[p].empty()) impulse[index(ends_[p])] += step.impulses[p][0];
  const std::vector<double> from = moves ? state_.u : std::vector<double>(state_.u.size(), 0.0);
  if (moves) {
    std::vector<double> force;
    pass_loads(step, force);
    const std::vector<double> loads = force;
    for (std::size_t i = 0; i < force.size(); ++i)
      force[i] += bar_->data().body_force * bar_->row_mass()[i];
    midpoint_->step(step.length(), force, impulse, state_.u, state_.v);
    for (std::size_t i = 0; i < loads.size(); ++i) load_work_ += loads[i] * (state_.u[i] - from[i]);
    for (const int end : {0, 1}) {
      EndState& e = state_.end[index(end)];
      e.force = e.dynamic = -Bar::outward(end) * impulse[index(end)] / step.length();
    }
    if (auto failed = compressed_to_nothing(state_.u, bar_->spacing(), step.end, description_.name))
      return failed;
  }
  std::vector<int> pressed;
  reply.ports.resize(ends_.size());
  for (std::size_t p = 0; p < ends_.size(); ++p) {
    const std::size_t node = index(bar_->node_of(ends_[p]));
    reply.ports[p].displacement = {state_.u[node] - from[node]};
    reply.ports[p].velocity = {state_.v[node]};
    if (p < step.pressed.size() && !step.pressed[p].empty()) pressed.push_back(ends_[p]);
  }
  reply.compliance.clear();
  for (const int of : pressed)
    for (const int by : pressed) reply.compliance.push_back(midpoint_->compliance(of, by));
  reply.bulge = reply.held = 0.0;
  return std::nullopt;
}

}  // namespace abut
