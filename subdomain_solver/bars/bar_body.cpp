#include "subdomain_solver/bars/bar_body.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "subdomain_solver/bars/bar_fields.hpp"
#include "subdomain_solver/bars/compressed_bar.hpp"
#include "subdomain_solver/saved_state.hpp"

namespace abut {

namespace {

/// Element-steps between two signs of life: about 10 ms of work.
constexpr double progress_work = 2.0e7;

}  // namespace

BarBody::BarBody(std::string name, std::unique_ptr<Bar> bar, Scheme scheme,
                 const std::vector<BodyPort>& ports)
    : bar_(std::move(bar)),
      scheme_(std::move(scheme)),
      partners_(ports.size()),
      imposed_(ports.size()) {
  const std::size_t n = index(bar_->nodes());
  state_.u.assign(n, 0.0);
  state_.v.assign(n, bar_->data().velocity);
  state_.a.assign(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    if (bar_->inverse_mass()[i] > 0.0) state_.a[i] = bar_->data().body_force;
  }
  for (int end : {0, 1}) {
    if (bar_->data().fixed[index(end)]) {
      state_.v[index(bar_->node_of(end))] = 0.0;
    }
  }
  description_.name = std::move(name);
  description_.model = fmt::format("bar, {} elements, {}", bar_->data().elements, scheme_.words);
  description_.dim = 1;
  description_.dofs = bar_->nodes();
  description_.mass = bar_->data().mass_total();
  description_.step = scheme_.step;
  description_.stable_step =
      scheme_.explicit_in_time ? bar_->stable_step() : std::numeric_limits<double>::infinity();
  const BarProperties& data = bar_->data();
  description_.conserves = scheme_.conserves && data.bulk_viscosity == 0.0 && data.tchamwa <= 1.0 &&
                           data.layer[0] != ContactLayer::massive &&
                           data.layer[1] != ContactLayer::massive;
  description_.fields = bar_fields();
  describe_ports(ports);
}

void BarBody::describe_ports(const std::vector<BodyPort>& ports) {
  Capabilities& can = description_.can;
  can.force = true;
  can.kernel = can.obstacle = can.yielding = can.impedance = can.impulse = !ports.empty();
  for (const BodyPort& p : ports) {
    const ContactLayer layer = bar_->data().layer[index(p.end)];
    if (layer == ContactLayer::massive) {
      can.motion = true;
      can.kernel = can.obstacle = can.yielding = can.impedance = false;
    }
    support_[p.end] = layer == ContactLayer::kick ? ForceSupport::step : ForceSupport::nodal;
    end_of_port_.push_back(p.end);
    Port port;
    port.name = p.name;
    port.tied = p.tied;
    port.geometry.dim = 1;
    port.geometry.points = {bar_->data().position + (p.end == 0 ? 0.0 : bar_->data().length)};
    port.geometry.normals = {Bar::outward(p.end)};
    port.geometry.spacing = bar_->spacing();
    port.geometry.transit = bar_->spacing() / bar_->data().wave_speed();
    description_.ports.push_back(std::move(port));
  }
}

void BarBody::meet(int port, const PortGeometry& partner, const ContactLaw& law) {
  const PortGeometry& own = description_.ports.at(index(port)).geometry;
  const double gap = own.normals[0] * (partner.points.at(0) - own.points[0]);
  partners_[index(port)].push_back({law.tied ? 0.0 : std::max(0.0, gap), law.tied, {}});
}

void BarBody::yields(int port, int partner, const PortKernel& kernel) {
  const ForceSupport support = support_[end_of_port_.at(index(port))];
  if (kernel.step != scheme_.step || kernel.support != support || kernel.per_step() != 1) {
    throw RunError(fmt::format("gives way by a kernel of steps of {:g} s, but this body has {:g} s "
                               "and reactions of the same support",
                               kernel.step, scheme_.step),
                   fmt::format("a partner of body '{}'", description_.name),
                   "Let obstacles yield only with kernels of this body's step and support.");
  }
  partners_[index(port)].at(index(partner)).kernel = kernel;
}

void BarBody::save() { save_state(state_, saved_); }

void BarBody::restore() { restore_state(state_, saved_); }

std::vector<std::byte> BarBody::checkpoint() { return checkpoint_of(state_); }

void BarBody::resume(std::span<const std::byte> bytes) {
  BarState resumed = state_of_checkpoint<BarState>(bytes);
  const std::size_t n = state_.u.size();
  if (resumed.u.size() != n || resumed.v.size() != n || resumed.a.size() != n) {
    throw RunError(
        fmt::format("the checkpoint holds {} nodes, but the body has {}", resumed.u.size(), n),
        fmt::format("body '{}'", description_.name),
        "Resume with the mesh that wrote the checkpoint.");
  }
  state_ = std::move(resumed);
}

std::uint64_t BarBody::state_hash() { return hash_state(state_); }

Grid BarBody::grid() {
  Grid grid;
  add_bar(bar_->data(), grid);
  return grid;
}

std::vector<FieldValues> BarBody::fields() {
  std::vector<double> u = state_.u, stress;
  u.front() = scheme_.integrator->port_displacement(state_, 0);  // as partners see the ends
  u.back() = scheme_.integrator->port_displacement(state_, 1);
  for (std::size_t e = 0; e + 1 < u.size(); ++e)
    stress.push_back(bar_->stiffness()[e] * (u[e + 1] - u[e]) / bar_->data().area);
  return bar_field_values(u, state_.v, stress);
}

Outcome BarBody::finish(Response& response) {
  ABUT_ASSERT(request_ != nullptr);
  const Advance& request = *request_;
  request_ = nullptr;
  const auto began = std::chrono::steady_clock::now();
  response.records.resize(index(std::max(1, request.records)));
  recorded_ = 0;
  // Of the window's begin, which is accepted: iterates may lie anywhere.
  if (std::optional<Failed> failed = check_compression(request.window.begin)) return *failed;
  begin_traces(request, response);
  for (EndState& e : state_.end) e.work = 0.0;
  apply_impulses(request);
  begin_sweep();
  const Substeps grid = Substeps::divide(request.window.begin, request.window.end, scheme_.step);
  std::optional<Failed> failed = advance_window(request, grid, response);
  if (failed) return *failed;
  finish_ports(response);
  response.steps = grid.count;
  response.compute_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return Advanced{};
}

std::optional<Failed> BarBody::advance_window(const Advance& request, const Substeps& grid,
                                              Response& response) {
  BarIntegrator& integrator = *scheme_.integrator;
  find_same_grids(request, grid);
  const bool driven = std::any_of(request.boundary.begin(), request.boundary.end(),
                                  [](const BoundaryData& data) { return data.closed(); });
  EndActions actions;
  set_actions(request, grid, 0, actions);
  EndPlaces places = end_places();
  if (grid.count > 0) integrator.open(state_, grid.length(1), actions);
  if (driven) add_work(places);
  RecordClock clock(request, grid.count);
  for (int i = 1; i <= grid.count; ++i) {
    if (driven) set_actions(request, grid, i, actions);
    integrator.substep(state_, grid.length(i), actions);
    if (driven) add_work(places);
    const bool due = i == clock.substep();
    if (due) integrator.close(state_, grid.length(i));  // u, v and a of one time
    if (request.sampling == Sampling::substeps) {
      push_traces(request, grid.time(i), response);
    } else {
      track_sweep();
    }
    report_progress();
    if (!due) continue;
    if (request.sampling == Sampling::records) push_traces(request, clock.time(), response);
    for (; i == clock.substep(); clock.next()) {
      if (std::optional<Failed> failed = record(clock.time(), response)) return failed;
    }
    if (i < grid.count) integrator.open(state_, grid.length(i + 1), actions);
  }
  for (; !clock.done(); clock.next()) {  // a window of no length
    if (std::optional<Failed> failed = record(clock.time(), response)) return failed;
  }
  return std::nullopt;
}

BarBody::EndPlaces BarBody::end_places() const {
  EndPlaces places{};
  for (int end : end_of_port_) {
    const std::size_t e = index(end);
    places[e] = {Bar::outward(end) * state_.u[index(bar_->node_of(end))], state_.end[e].dynamic};
  }
  return places;
}

/// Of the ends' forces since `before`, which moves on  [M.23]. Kicks keep their own account.
void BarBody::add_work(EndPlaces& before) {
  const EndPlaces now = end_places();
  for (int end : end_of_port_) {
    if (support_[end] == ForceSupport::step) continue;
    const std::size_t e = index(end);
    state_.end[e].work -=
        0.5 * (before[e].force + now[e].force) * (now[e].outward - before[e].outward);
  }
  before = now;
}

void BarBody::find_same_grids(const Advance& request, const Substeps& grid) {
  for (std::size_t p = 0; p < end_of_port_.size(); ++p) {
    const BoundaryData& data = request.boundary[p];
    Imposed& imposed = imposed_[p];
    imposed.same_grid.clear();
    for (const Waveform& force : data.forces) {
      imposed.same_grid.push_back(!force.empty() && grid.matches(force.time) &&
                                  force.support == support_[end_of_port_[p]]);
    }
    imposed.obstacle = -1;
    imposed.excess.clear();
    for (std::size_t k = 0; k < data.obstacles.size(); ++k) {
      if (data.obstacles[k].empty()) continue;
      if (imposed.obstacle >= 0 || data.pushed() || k >= partners_[p].size()) {
        throw RunError("an end of a bar takes one obstacle at a time, of a partner that it has met",
                       fmt::format("body '{}'", description_.name),
                       "Give one of the partners the other role.");
      }
      imposed.obstacle = static_cast<int>(k);
      imposed.same_motion = grid.matches(data.obstacles[k].motion.time);
    }
  }
}

void BarBody::set_actions(const Advance& request, const Substeps& grid, int i,
                          EndActions& actions) {
  const double time = i == 0 ? grid.begin : grid.time(i);
  for (std::size_t p = 0; p < end_of_port_.size(); ++p) {
    const BoundaryData& data = request.boundary[p];
    EndAction& action = actions[index(end_of_port_[p])];
    action.held = description_.ports[p].tied;
    if (imposed_[p].obstacle >= 0) {
      set_obstacle(data.obstacles[index(imposed_[p].obstacle)], grid, i, p, action);
    } else if (!data.motion.empty()) {
      action.kind = EndAction::Kind::motion;
      data.motion.interpolate(data.motion.u, time, {&action.u, 1});
      data.motion.interpolate(data.motion.v, time, {&action.v, 1});
      data.motion.interpolate(data.motion.a, time, {&action.a, 1});
    } else if (data.pushed()) {
      const int end = end_of_port_[p];
      action.kind = EndAction::Kind::open;
      for (std::size_t k = 0; k < data.forces.size(); ++k) {
        if (!data.forces[k].empty())
          add_force(data.forces[k], imposed_[p].same_grid[k], grid, i, end, action);
      }
      if (!data.impedance.empty()) resist(data.impedance, grid, i, end, action);
    }
  }
}

void BarBody::set_obstacle(const Obstacle& obstacle, const Substeps& grid, int i, std::size_t port,
                           EndAction& action) {
  const Imposed& imposed = imposed_[port];
  const Partner& partner = partners_[port][index(imposed.obstacle)];
  const double n = Bar::outward(end_of_port_[port]);
  const Waveform& motion = obstacle.motion;
  double u = 0.0;
  if (imposed.same_motion) {
    u = motion.u[index(i)];
  } else {
    motion.interpolate(motion.u, i == 0 ? grid.begin : grid.time(i), {&u, 1});
  }
  action.kind = EndAction::Kind::obstacle;
  action.yield = action.give = 0.0;
  action.target = n * (partner.gap * n + u);
  action.bilateral = partner.tied;
  if (partner.kernel.count() > 0) give_way(obstacle, i, port, action);
}

/// What the surface has given way by the reactions so far, and how much it does per newton of this
/// substep's.
void BarBody::give_way(const Obstacle& obstacle, int i, std::size_t port, EndAction& action) {
  Imposed& imposed = imposed_[port];
  const PortKernel& kernel = partners_[port][index(imposed.obstacle)].kernel;
  const std::vector<double>& under = obstacle.motion.f;
  const double n = Bar::outward(end_of_port_[port]);
  const EndState& end = state_.end[index(end_of_port_[port])];
  if (!imposed.same_motion || under.size() != obstacle.motion.size() ||
      kernel.count() + 1 < static_cast<int>(under.size())) {
    throw RunError("an obstacle that gives way has other times than the body's substeps, no force, "
                   "or a kernel that is too short",
                   fmt::format("body '{}'", description_.name),
                   "Give its motion and its force at every substep.");
  }
  if (i == 0) {  // the reaction of this instant is known, and moves no end by the target
    imposed.excess.assign(1, n * end.force - under[0]);
    return;
  }
  if (i > 1) imposed.excess.push_back(n * end.force - under[index(i) - 1]);
  double moved = -kernel.displacement[0] * under[index(i)];
  if (!kernel.begin.empty()) moved += kernel.begin[index(i) - 1] * imposed.excess[0];
  for (std::size_t j = 1; j < index(i); ++j)
    moved += kernel.displacement[index(i) - j] * imposed.excess[j];
  action.target += n * moved;
  action.give = kernel.displacement[0];
}

void BarBody::resist(const Impedance& impedance, const Substeps& grid, int i, int end,
                     EndAction& action) const {
  // A dashpot over a substep is a spring from where the port was at its begin.
  action.kind = EndAction::Kind::obstacle;
  action.target = Bar::outward(end) * scheme_.integrator->port_displacement(state_, end);
  action.yield = i > 0 ? impedance.value / grid.length(i) : 0.0;
  action.bilateral = impedance.bilateral;
}

/// Forces of several partners add up.
void BarBody::add_force(const Waveform& imposed, bool same_grid, const Substeps& grid, int i,
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
    force = inward * imposed.f[index(i)];
    return add(force, force);
  }
  const double now = i == 0 ? grid.begin : grid.time(i);
  imposed.force_at(now, {&force, 1});
  force *= inward;
  // massive: as published, the value at the substep's end
  if (bar_->data().layer[index(end)] == ContactLayer::massive) return add(force, force);
  const double before = i == 0 ? grid.begin : i == 1 ? grid.begin : grid.time(i - 1);
  const double after = i == grid.count ? grid.end : grid.time(i + 1);
  const bool step_support = support_[end] == ForceSupport::step;
  const double from = step_support ? before : 0.5 * (before + now);
  const double to = step_support ? now : 0.5 * (now + after);
  if (to <= from) return add(force, force);
  double impulse = 0.0;
  imposed.impulse(from, to, {&impulse, 1});
  const double mean = inward * impulse / (to - from);
  add(step_support ? mean : force, mean);
}

void BarBody::apply_impulses(const Advance& request) {
  for (std::size_t p = 0; p < end_of_port_.size(); ++p) {
    if (request.boundary[p].impulse.empty()) continue;
    scheme_.integrator->strike(state_, end_of_port_[p], request.boundary[p].impulse[0]);
  }
}

double BarBody::force_on_body(int end, const BoundaryData& data) const {
  const ContactLayer layer = bar_->data().layer[index(end)];
  if (layer == ContactLayer::massive) {
    // As published: what is handed over is the internal force of the contact node, without its
    // inertia. A complete reaction holds both.
    if (!data.closed()) return 0.0;
    const double internal = scheme_.integrator->internal_force(state_, end);
    if (!bar_->data().complete_reaction) return internal;
    if (data.motion.empty()) return -Bar::outward(end) * state_.end[index(end)].force;
    const std::size_t node = index(bar_->node_of(end));
    return internal + bar_->row_mass()[node] * (state_.a[node] - bar_->data().body_force);
  }
  return -Bar::outward(end) * state_.end[index(end)].force;
}

void BarBody::begin_traces(const Advance& request, Response& response) {
  response.ports.resize(end_of_port_.size());
  for (std::size_t p = 0; p < response.ports.size(); ++p) {
    response.ports[p].trace.clear();
    response.ports[p].trace.support = support_[end_of_port_[p]];
    response.ports[p].lower.clear();
    response.ports[p].upper.clear();
  }
  begin_reactions(request, response);
  push_traces(request, request.window.begin, response);
}

void BarBody::begin_reactions(const Advance& request, Response& response) const {
  for (std::size_t p = 0; p < response.ports.size(); ++p) {
    std::vector<Reaction>& reactions = response.ports[p].reactions;
    reactions.resize(request.boundary[p].obstacles.size());
    for (std::size_t k = 0; k < reactions.size(); ++k) {
      reactions[k].force.clear();
      reactions[k].force.support = response.ports[p].trace.support;
      reactions[k].force.points = request.boundary[p].obstacles[k].motion.points;
    }
  }
}

void BarBody::push_traces(const Advance& request, double time, Response& response) {
  for (std::size_t p = 0; p < end_of_port_.size(); ++p) push_trace(request, time, p, response);
}

void BarBody::push_trace(const Advance& request, double time, std::size_t p, Response& response) {
  const int end = end_of_port_[p];
  const std::size_t node = index(bar_->node_of(end));
  PortResponse& port = response.ports[p];
  const double u = scheme_.integrator->port_displacement(state_, end);
  double v = state_.v[node];
  // Kicks make the nodal velocity jump within a substep; the mean over it is the contact point's
  // velocity.
  const bool kicked = support_[end] == ForceSupport::step && state_.end[index(end)].closed;
  if (kicked && !port.trace.empty()) v = (u - imposed_[p].last) / (time - port.trace.time.back());
  imposed_[p].last = u;
  EndState& e = state_.end[index(end)];
  e.swept_low = std::min(e.swept_low, u);
  e.swept_high = std::max(e.swept_high, u);
  const double force = force_on_body(end, request.boundary[p]);
  const Want want = request.want.empty() ? Want{} : request.want[p];
  port.trace.time.push_back(time);
  if (want.u) port.trace.u.push_back(u);
  if (want.v) port.trace.v.push_back(v);
  if (want.a) port.trace.a.push_back(state_.a[node]);
  if (want.f) port.trace.f.push_back(force);
  for (std::size_t k = 0; k < port.reactions.size(); ++k) {
    if (request.boundary[p].obstacles[k].empty()) continue;
    port.reactions[k].force.time.push_back(time);
    port.reactions[k].force.f.push_back(-force);
  }
}

void BarBody::track_sweep() {
  for (int end : end_of_port_) {
    const double u = scheme_.integrator->port_displacement(state_, end);
    EndState& e = state_.end[index(end)];
    e.swept_low = std::min(e.swept_low, u);
    e.swept_high = std::max(e.swept_high, u);
  }
}

void BarBody::begin_sweep() {
  for (int end : end_of_port_) {
    EndState& e = state_.end[index(end)];
    e.swept_low = e.swept_high = scheme_.integrator->port_displacement(state_, end);
  }
}

void BarBody::end_sweep(Response& response) const {
  for (std::size_t p = 0; p < end_of_port_.size(); ++p) {
    const EndState& e = state_.end[index(end_of_port_[p])];
    const double reference = description_.ports[p].geometry.points[0];
    response.ports[p].lower.push_back(reference + e.swept_low);
    response.ports[p].upper.push_back(reference + e.swept_high);
  }
}

std::optional<Failed> BarBody::record(double time, Response& response) {
  end_sweep(response);
  begin_sweep();
  BodyRecord& r = response.records[recorded_++];
  r.time = time;
  r.energy = {};
  r.energy.kinetic = scheme_.integrator->kinetic(state_);
  r.energy.stored = scheme_.integrator->stored(state_);
  const double body_force = bar_->data().body_force;
  if (body_force != 0.0) r.energy.external_work = body_force * bar_->momentum(state_.u);  // f . u
  r.momentum.assign(1, bar_->momentum(state_.v) + scheme_.integrator->momentum_lag(state_));
  return check_finite(r);
}

/// With the ends where partners see them: they are the contact elements' own.
std::optional<Failed> BarBody::check_compression(double time) {
  const double left = state_.u.front(), right = state_.u.back();
  state_.u.front() = scheme_.integrator->port_displacement(state_, 0);
  state_.u.back() = scheme_.integrator->port_displacement(state_, 1);
  std::optional<Failed> failed =
      compressed_to_nothing(state_.u, bar_->spacing(), time, description_.name);
  state_.u.front() = left;
  state_.u.back() = right;
  return failed;
}

void BarBody::finish_ports(Response& response) {
  for (std::size_t p = 0; p < end_of_port_.size(); ++p) {
    const int end = end_of_port_[p];
    const EndState& e = state_.end[index(end)];
    PortResponse& port = response.ports[p];
    port.work = e.work;
    port.recoil = scheme_.integrator->recoil(state_, end);
    if (e.force == 0.0) approach(end, port);
  }
}

void BarBody::approach(int end, PortResponse& port) const {
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
  port.speed_bound = high + 0.1 * std::max(0.0, high - low);
  port.acceleration_bound = std::abs(bar_->data().body_force);
}

std::optional<Failed> BarBody::check_finite(const BodyRecord& record) const {
  // A value that is not finite anywhere in the state reaches one of these sums.
  const double sum = record.energy.kinetic + record.energy.stored + record.momentum[0];
  if (std::isfinite(sum)) return std::nullopt;
  return Failed{
      Failed::Cause::non_finite, record.time,
      fmt::format("the state of body '{}' is no longer finite; its step of {:g} s may be unstable "
                  "or a value out of range: give a smaller step, check the scene's values",
                  description_.name, scheme_.step)};
}

void BarBody::report_progress() {
  if (!progress_) return;
  work_since_progress_ += bar_->data().elements;
  if (work_since_progress_ < progress_work) return;
  work_since_progress_ = 0.0;
  progress_();
}

std::vector<double> BarBody::respond_from_rest(int end, double step, int count, double at_begin,
                                               double in_first) {
  // An outward pull is a negative contact force; the port stays grounded during the whole probe.
  const std::size_t n = state_.u.size();
  state_ = BarState{};
  state_.u.assign(n, 0.0);
  state_.v.assign(n, 0.0);
  state_.a.assign(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    if (bar_->inverse_mass()[i] > 0.0) state_.a[i] = bar_->data().body_force;
  }
  state_.end[index(end)].closed = true;
  EndActions actions;
  EndAction& action = actions[index(end)];
  action.kind = EndAction::Kind::force;
  action.held = true;
  action.force = action.dynamic = -at_begin;
  scheme_.integrator->open(state_, step, actions);
  std::vector<double> displacement;
  for (int i = 1; i <= count; ++i) {
    action.force = action.dynamic = i == 1 ? -in_first : 0.0;
    scheme_.integrator->substep(state_, step, actions);
    displacement.push_back(Bar::outward(end) * scheme_.integrator->port_displacement(state_, end));
  }
  return displacement;
}

PortKernel BarBody::probe(int port, std::span<const double> patterns, double step, int count) {
  ABUT_ASSERT(port >= 0 && index(port) < end_of_port_.size() && step > 0.0);
  const BarState kept = state_;
  const int end = end_of_port_[index(port)];
  const double n = Bar::outward(end);
  PortKernel kernel;
  kernel.step = step;
  kernel.support = support_[end];
  kernel.patterns = static_cast<int>(patterns.size());
  const std::size_t values = index(count) * patterns.size();
  const bool nodal = kernel.support == ForceSupport::nodal;
  const double compliance = scheme_.integrator->static_compliance(end);
  kernel.displacement.assign(values, 0.0);
  if (nodal) kernel.begin.assign(values, 0.0);
  // what the body force does alone is no response
  const std::vector<double> alone = bar_->data().body_force != 0.0
                                        ? respond_from_rest(end, step, count, 0.0, 0.0)
                                        : std::vector<double>(index(count), 0.0);
  for (std::size_t k = 0; k < patterns.size(); ++k) {
    const double pull = n * patterns[k];
    const auto write = [&](const std::vector<double>& response, std::vector<double>& to) {
      for (std::size_t i = 0; i < alone.size(); ++i)
        to[i * patterns.size() + k] = n * (response[i] - alone[i]);
    };
    if (compliance > 0.0) kernel.compliance.push_back(compliance * patterns[k]);
    write(respond_from_rest(end, step, count, 0.0, pull), kernel.displacement);
    if (nodal) write(respond_from_rest(end, step, count, pull, 0.0), kernel.begin);
  }
  state_ = kept;
  return kernel;
}

}  // namespace abut
