#include "subdomain_solver/bars/bar_interior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "contract/kernel_misfit.hpp"
#include "subdomain_solver/bars/bar_fields.hpp"
#include "subdomain_solver/bars/compressed_bar.hpp"

namespace abut {

namespace {

/// Element-steps in about 10 ms.
constexpr double usual_bar_work = 2.0e7;

}  // namespace

BarInterior::BarInterior(std::string name, std::unique_ptr<Bar> bar, Scheme scheme,
                         const std::vector<End>& ends, Extras extras)
    : bar_(std::move(bar)),
      scheme_(std::move(scheme)),
      shown_(ends.size()),
      loads_(std::move(extras.loads)),
      late_(loads_ != nullptr || !extras.displacement.empty()),
      begun_(!late_) {
  lie_down();
  std::fill(state_.v.begin(), state_.v.end(), bar_->data().velocity);
  set_fields(extras);
  describe(std::move(name), ends);
  for (const End& e : ends)  // held from the begin, which its energy knows
    if (e.tied && bar_->data().layer[e.end] == ContactLayer::kick) state_.end[e.end].closed = true;
}

void BarInterior::set_fields(const Extras& extras) {
  for (std::size_t i = 0; i < extras.velocity.size(); ++i) state_.v[i] += extras.velocity[i];
  for (std::size_t i = 0; i < extras.displacement.size(); ++i) state_.u[i] = extras.displacement[i];
  for (int end : {0, 1}) {
    if (!bar_->data().fixed[end]) continue;
    state_.u[bar_->node_of(end)] = state_.v[bar_->node_of(end)] = 0.0;
  }
  lifted_ = bar_->momentum(state_.u);
  const bool damped = bar_->data().bulk_viscosity > 0.0 && !extras.velocity.empty();
  if (begun_ && damped) scheme_.integrator->begin(state_, {});
}

/// The state of the start, which the first substep leaves. Where an obstacle is met at once, the
/// end stands against it from the begin; the energy that this takes is told as work.
void BarInterior::start(const Window& window) {
  scheme_.integrator->begin(state_, {});
  if (window.grid.count == 0) return;
  begun_ = true;
  actions_ = {};
  bool pressed = false;
  for (std::size_t p = 0; p < ends_.size(); ++p) {
    if (!imposed_[p].obstacle.acts()) continue;
    set_obstacle(0, p, actions_[ends_[p]]);
    pressed = true;
  }
  if (!pressed) return;
  const double alone = scheme_.integrator->kinetic(state_) + scheme_.integrator->stored(state_);
  scheme_.integrator->begin(state_, actions_);
  load_work_ += scheme_.integrator->kinetic(state_) + scheme_.integrator->stored(state_) - alone;
}

void BarInterior::state(Archive& archive) {
  state_.state(archive);
  if (!late_) return;
  archive.field("begun", begun_);
  archive.field("load_work", load_work_);
}

void BarInterior::describe(std::string name, const std::vector<End>& ends) {
  const BarProperties& data = bar_->data();
  description_.name = std::move(name);
  description_.model = fmt::format("bar, {} elements, {}", data.elements, scheme_.words);
  description_.dim = 1;
  description_.dofs = bar_->nodes();
  description_.mass = data.mass_total();
  description_.step = scheme_.step;
  description_.stable_step =
      scheme_.explicit_in_time ? bar_->stable_step() : std::numeric_limits<double>::infinity();
  description_.conserves = scheme_.conserves && data.bulk_viscosity == 0.0 && data.tchamwa <= 1.0 &&
                           data.layer[0] != ContactLayer::massive &&
                           data.layer[1] != ContactLayer::massive;
  description_.linear = data.bulk_viscosity == 0.0;
  description_.fields = bar_fields();
  Capabilities& can = description_.can;
  can.force = true;
  can.kernel = can.obstacle = can.yielding = can.impedance = can.impulse = !ends.empty();
  for (const End& e : ends) {
    if (data.layer[e.end] == ContactLayer::massive) {
      can.motion = true;
      can.kernel = can.obstacle = can.yielding = can.impedance = false;
    }
    ends_.push_back(e.end);
    const bool kick = data.layer[e.end] == ContactLayer::kick;
    traits_.support.push_back(kick ? ForceSupport::step : ForceSupport::nodal);
    Port port;
    port.name = e.name;
    port.tied = e.tied;
    port.geometry.points = {data.position + (e.end == 0 ? 0.0 : data.length)};
    port.geometry.normals = {Bar::outward(e.end)};
    port.geometry.spacing = bar_->spacing();
    port.geometry.transit = bar_->spacing() / data.wave_speed();
    imposed_.push_back({{}, {port.geometry.points[0], Bar::outward(e.end), description_.name}});
    description_.ports.push_back(std::move(port));
  }
  for (std::vector<double>* values : {&seen_.u, &seen_.v, &seen_.a, &seen_.f})
    values->resize(ends.size());
  traits_.effort = data.elements / usual_bar_work;
  traits_.scheme = scheme_.words.substr(0, scheme_.words.find(','));
  if (ends.empty()) return;
  able_.probed = this;
  able_.obstructed = this;
  able_.passive = this;
  can.passive = true;
}

std::size_t BarInterior::coordinates() const {
  const std::size_t n = state_.u.size();
  return state_.v.size() == n && (is_passive() || state_.a.size() == n) ? n : 0;
}

double BarInterior::compliance(std::size_t port) const {
  return scheme_.integrator->static_compliance(ends_[port]);
}

std::string BarInterior::misfit(int port, const PortKernel& kernel) const {
  if (!description_.can.yielding) return "it takes none";
  return misfit_of(kernel, scheme_.step, support(index(port)), 1);
}

Grid BarInterior::grid() {
  Grid grid;
  add_bar(bar_->data(), grid);
  return grid;
}

std::vector<FieldValues> BarInterior::fields() {
  std::vector<double> u = state_.u, stress;
  u.front() = scheme_.integrator->port_displacement(state_, 0);  // as partners see the ends
  u.back() = scheme_.integrator->port_displacement(state_, 1);
  for (std::size_t e = 0; e + 1 < u.size(); ++e)
    stress.push_back(bar_->stiffness()[e] * (u[e + 1] - u[e]) / bar_->data().area);
  return bar_field_values(u, state_.v, stress);
}

/// Looks at the window's begin, which is accepted: iterates may lie anywhere. The ends count where
/// partners see them: they are the contact elements' own.
std::optional<Failed> BarInterior::begin(const Window& window) {
  see_imposed(window);
  if (loaded()) meet_loads(window.request.window.begin);
  if (!begun_) start(window);
  for (EndState& e : state_.end) e.work = 0.0;
  const double left = state_.u.front(), right = state_.u.back();
  state_.u.front() = scheme_.integrator->port_displacement(state_, 0);
  state_.u.back() = scheme_.integrator->port_displacement(state_, 1);
  std::optional<Failed> failed = compressed_to_nothing(
      state_.u, bar_->spacing(), window.request.window.begin, description_.name);
  state_.u.front() = left;
  state_.u.back() = right;
  return failed;
}

void BarInterior::set_off(const Window& window) {
  for (std::size_t p = 0; p < ends_.size(); ++p) {
    const std::vector<double>& impulse = window.request.boundary[p].impulse;
    if (!impulse.empty()) scheme_.integrator->strike(state_, ends_[p], impulse[0]);
  }
  actions_ = {};
  set_actions(window, 0);
  places_ = end_places();
  open_ = false;
  if (window.grid.count == 0) return;
  if (loaded()) worked_ = state_.u;
  scheme_.integrator->open(state_, window.grid.length(1), actions_);
  open_ = true;
  if (driven_) add_work();
  if (loaded()) add_load_work();
}

std::optional<Failed> BarInterior::step(const Window& window, int i, bool whole) {
  const double dt = window.grid.length(i);
  if (!open_) scheme_.integrator->open(state_, dt, actions_);
  open_ = true;
  if (driven_) set_actions(window, i);
  if (loaded()) bear_loads(window.grid.time(i));
  scheme_.integrator->substep(state_, dt, actions_);
  if (driven_) add_work();
  if (loaded()) add_load_work();
  if (!whole) return std::nullopt;
  scheme_.integrator->close(state_, dt);
  open_ = false;
  return std::nullopt;
}

BarInterior::EndPlaces BarInterior::end_places() const {
  EndPlaces places{};
  for (int end : ends_) {
    const std::size_t e = index(end);
    places[e] = {Bar::outward(end) * state_.u[bar_->node_of(end)], state_.end[e].dynamic};
  }
  return places;
}

/// Of the ends' forces since they were last seen [M.23]. Kicks keep their own account.
void BarInterior::add_work() {
  const EndPlaces now = end_places();
  for (std::size_t p = 0; p < ends_.size(); ++p) {
    if (support(p) == ForceSupport::step) continue;
    const std::size_t e = index(ends_[p]);
    state_.end[e].work -=
        0.5 * (places_[e].force + now[e].force) * (now[e].outward - places_[e].outward);
  }
  places_ = now;
}

/// Of a window's begin.
void BarInterior::meet_loads(double time) {
  NodeForces& forces = scheme_.integrator->loads();
  loads_->at(time, forces.now);
  forces.before = forces.now;
}

/// Of a substep that ends at `time`.
void BarInterior::bear_loads(double time) {
  NodeForces& forces = scheme_.integrator->loads();
  forces.before.swap(forces.now);
  loads_->at(time, forces.now);
}

/// Of the loads since they were last seen: the mean of theirs at both ends [M.84]. When a window
/// opens nothing but a massless end moves, under the loads of that instant.
void BarInterior::add_load_work() {
  const NodeForces& forces = scheme_.integrator->loads();
  double work = 0.0;
  for (std::size_t i = 0; i < worked_.size(); ++i)
    work += 0.5 * (forces.before[i] + forces.now[i]) * (state_.u[i] - worked_[i]);
  load_work_ += work;
  worked_ = state_.u;
}

void BarInterior::see_imposed(const Window& window) {
  driven_ = false;
  for (std::size_t p = 0; p < ends_.size(); ++p) {
    const BoundaryData& data = window.request.boundary[p];
    Imposed& imposed = imposed_[p];
    driven_ = driven_ || data.closed();
    imposed.same_grid.clear();
    for (const Waveform& force : data.forces) {
      imposed.same_grid.push_back(!force.empty() && window.grid.matches(force.time) &&
                                  force.support == support(p));
    }
    imposed.obstacle.impose(data, window.partners[p], window.grid);
  }
}

void BarInterior::set_actions(const Window& window, int i) {
  const Substeps& grid = window.grid;
  const double time = i == 0 ? grid.begin : grid.time(i);
  for (std::size_t p = 0; p < ends_.size(); ++p) {
    const BoundaryData& data = window.request.boundary[p];
    EndAction& action = actions_[ends_[p]];
    action.held = description_.ports[p].tied || probed_ == static_cast<int>(p);
    if (imposed_[p].obstacle.acts()) {
      set_obstacle(i, p, action);
    } else if (!data.motion.empty()) {
      action.kind = EndAction::Kind::motion;
      data.motion.interpolate(data.motion.u, time, {&action.u, 1});
      data.motion.interpolate(data.motion.v, time, {&action.v, 1});
      data.motion.interpolate(data.motion.a, time, {&action.a, 1});
    } else if (data.pushed()) {
      action.kind = EndAction::Kind::open;
      for (std::size_t k = 0; k < data.forces.size(); ++k) {
        if (!data.forces[k].empty())
          add_force(data.forces[k], imposed_[p].same_grid[k], grid, i, ends_[p], action);
      }
      if (!data.impedance.empty()) resist(data.impedance, grid, i, ends_[p], action);
    }
  }
}

void BarInterior::set_obstacle(int i, std::size_t port, EndAction& action) {
  const int end = ends_[port];
  const PointObstacle::Surface surface =
      imposed_[port].obstacle.at(i, Bar::outward(end) * state_.end[end].force);
  action.kind = EndAction::Kind::obstacle;
  action.yield = 0.0;
  action.target = surface.target;
  action.give = surface.give;
  action.bilateral = surface.bilateral;
}

void BarInterior::resist(const Impedance& impedance, const Substeps& grid, int i, int end,
                         EndAction& action) const {
  // A dashpot over a substep is a spring from where the port was at its begin.
  action.kind = EndAction::Kind::obstacle;
  action.target = Bar::outward(end) * scheme_.integrator->port_displacement(state_, end);
  action.yield = i > 0 ? impedance.value / grid.length(i) : 0.0;
  action.bilateral = impedance.bilateral;
}

/// Forces of several partners add up.
void BarInterior::add_force(const Waveform& imposed, bool same_grid, const Substeps& grid, int i,
                            int end, EndAction& action) const {
  const double inward = -Bar::outward(end);
  const auto add = [&action](double force, double dynamic) {
    const bool first = action.kind != EndAction::Kind::force;
    action.kind = EndAction::Kind::force;
    action.force = first ? force : action.force + force;
    action.dynamic = first ? dynamic : action.dynamic + dynamic;
  };
  double force = 0.0;
  if (same_grid) {  // the common case, and exact: no averaging at all
    force = inward * imposed.f[i];
    return add(force, force);
  }
  const double now = i == 0 ? grid.begin : grid.time(i);
  imposed.force_at(now, {&force, 1});
  force *= inward;
  const ContactLayer layer = bar_->data().layer[end];
  if (layer == ContactLayer::massive) return add(force, force);  // as published: of the end
  const double before = i == 0 ? grid.begin : i == 1 ? grid.begin : grid.time(i - 1);
  const double after = i == grid.count ? grid.end : grid.time(i + 1);
  const bool step_support = layer == ContactLayer::kick;
  const double from = step_support ? before : 0.5 * (before + now);
  const double to = step_support ? now : 0.5 * (now + after);
  if (to <= from) return add(force, force);
  double impulse = 0.0;
  imposed.impulse(from, to, {&impulse, 1});
  const double mean = inward * impulse / (to - from);
  add(step_support ? mean : force, mean);
}

double BarInterior::force_on_body(int end, const BoundaryData& data) const {
  const ContactLayer layer = bar_->data().layer[end];
  if (layer == ContactLayer::massive) {
    // As published: what is handed over is the internal force of the contact node, without its
    // inertia. A complete reaction holds both.
    if (!data.closed()) return 0.0;
    const std::size_t node = index(bar_->node_of(end));
    double internal = scheme_.integrator->internal_force(state_, end);
    if (loaded()) internal -= scheme_.integrator->loads().now[node];  // goes on to the partner
    if (!bar_->data().complete_reaction) return internal;
    if (data.motion.empty()) return -Bar::outward(end) * state_.end[end].force;
    return internal + bar_->row_mass()[node] * (state_.a[node] - bar_->data().body_force);
  }
  return -Bar::outward(end) * state_.end[end].force;
}

const PortValues& BarInterior::see(const Window& window, double time, bool all) {
  for (std::size_t p = 0; p < ends_.size(); ++p) {
    const int end = ends_[p];
    const double u = scheme_.integrator->port_displacement(state_, end);
    seen_.u[p] = u;
    if (!all) continue;
    const std::size_t node = index(bar_->node_of(end));
    seen_.v[p] = state_.v[node];
    seen_.a[p] = state_.a[node];
    seen_.f[p] = force_on_body(end, window.request.boundary[p]);
    // Kicks make the nodal velocity jump within a substep; the mean over it is the contact point's
    // velocity.
    const bool kicked = support(p) == ForceSupport::step && state_.end[end].closed;
    if (kicked && time > window.grid.begin)
      seen_.v[p] = (u - shown_[p].u) / (time - shown_[p].time);
    shown_[p] = {time, u};
  }
  return seen_;
}

void BarInterior::react(std::size_t port, std::size_t, std::vector<double>& force) const {
  force.push_back(Bar::outward(ends_[port]) * state_.end[ends_[port]].force);
}

std::optional<Failed> BarInterior::record(BodyRecord& r) {
  r.energy = {};
  r.energy.external_work = external_work();
  if (is_passive()) {
    r.energy.kinetic = midpoint_->kinetic(state_.v);
    r.energy.stored = bar_->stored(state_.u);
    r.momentum.assign(1, midpoint_->momentum(state_.v));
    return std::nullopt;
  }
  r.energy.kinetic = scheme_.integrator->kinetic(state_);
  r.energy.stored = scheme_.integrator->stored(state_);
  r.momentum.assign(1, bar_->momentum(state_.v) + scheme_.integrator->momentum_lag(state_));
  return std::nullopt;
}

double BarInterior::external_work() const {
  const double body_force = bar_->data().body_force;
  double work = load_work_;
  if (body_force != 0.0) work += body_force * (bar_->momentum(state_.u) - lifted_);  // f . u
  return work;
}

void BarInterior::finish(std::size_t port, PortResponse& reply) const {
  const int end = ends_[port];
  reply.work = state_.end[end].work;
  reply.recoil = scheme_.integrator->recoil(state_, end);
  // nobody knows what loads will do: no bound
  if (state_.end[end].force == 0.0 && !loaded()) approach(end, reply);
}

void BarInterior::approach(int end, PortResponse& reply) const {
  // A free end moves with the characteristics v -+ c strain that arrive there; all of them are
  // inside the bar now. A fixed far end turns signs around. Dispersion may overshoot: a tenth of
  // the range is added, and the coordinator checks the swept range anyway.
  const double c = bar_->data().wave_speed();
  const double n = Bar::outward(end);
  const bool turned = bar_->data().fixed[end == 0 ? 1 : 0];
  double high = -std::numeric_limits<double>::infinity();
  double low = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e + 1 < state_.u.size(); ++e) {
    const double strain = std::abs(state_.u[e + 1] - state_.u[e]) / bar_->spacing();
    const double v = 0.5 * n * (state_.v[e] + state_.v[e + 1]);
    high = std::max(high, (turned ? std::abs(v) : v) + c * strain);
    low = std::min(low, v - c * strain);
  }
  const std::size_t node = index(bar_->node_of(end));
  high = std::max(high, n * state_.v[node]);
  reply.speed_bound = high + 0.1 * std::max(0.0, high - low);
  reply.acceleration_bound = std::abs(bar_->data().body_force);
}

/// At rest, under the body force.
void BarInterior::lie_down() {
  const std::size_t n = index(bar_->nodes());
  state_ = BarState{};
  for (std::vector<double>* values : {&state_.u, &state_.v, &state_.a}) values->assign(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    if (bar_->inverse_mass()[i] > 0.0) state_.a[i] = bar_->data().body_force;
  }
}

/// Loads are put away. The body force stays: it is in the bar's properties.
bool BarInterior::rest(std::size_t port) {
  lie_down();
  scheme_.integrator->loads() = {};
  begun_ = true;
  load_work_ = 0.0;
  probed_ = static_cast<int>(port);
  state_.end[ends_[port]].closed = true;
  return bar_->data().body_force != 0.0;
}

}  // namespace abut
