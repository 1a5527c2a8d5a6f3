#include "subdomain_solver/solid_interior.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/index.hpp"
#include "subdomain_solver/bars/compressed_bar.hpp"
#include "subdomain_solver/contact/point_contact.hpp"
#include "subdomain_solver/contact/surface_contact.hpp"
#include "subdomain_solver/materials/crush_guard.hpp"
#include "subdomain_solver/port_geometry.hpp"
#include "subdomain_solver/solid_fields.hpp"
#include "subdomain_solver/stabilisation_measures.hpp"
#include "subdomain_solver/time/inertia.hpp"
#include "subdomain_solver/time/massless_layer.hpp"
#include "subdomain_solver/time/motion_views.hpp"
#include "subdomain_solver/time/quasi_static.hpp"
#include "subdomain_solver/time/stable_steps.hpp"
#include "subdomain_solver/validity_measures.hpp"

namespace abut {

namespace {

/// Cell-steps in about 10 ms.
constexpr double usual_solid_work = 1.0e3;

/// Degrees of freedom from which on a factorisation may take more than a moment.
constexpr std::int64_t long_factorisation = 30'000;

/// Speed [m/s] of the fastest wave at the undeformed state: of dilatation, or along a bar.
double fastest_wave(const FeModel& model) {
  const Moduli moduli = model.material().moduli();
  const double stiffness = model.mesh().dim == 1 ? moduli.youngs() : moduli.p_wave();
  return std::sqrt(stiffness / model.material().density());
}

/// [J] Half of the kick of what partners press, `force` (coordinates), has been given to a rigid
/// body's velocities at a step's end, though it has not moved the body: m (dt f/2m)^2/2. Neither
/// kinetic energy nor work of loads, it goes as the forces do [M.61].
double kicked_ahead(const RigidModel& body, const Motion& motion, Vector& force) {
  force = (0.5 * motion.step * force).cwiseQuotient(body.lumped_mass());
  return body.kinetic(motion.q, std::span(force.data(), index(force.size())));
}

/// Values of a joined port that belong to nodes without mass.
std::vector<std::size_t> massless_values(const std::vector<int>& massless, const NamedNodes& port,
                                         std::size_t first, int dim) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < port.nodes.size() * index(dim); ++k)
    if (std::ranges::binary_search(
            massless, port.nodes[k / index(dim)] * dim + static_cast<int>(k % index(dim))))
      out.push_back(first + k);
  return out;
}

}  // namespace

SolidInterior::SolidInterior(std::string name, Parts parts, const std::vector<PortNodes>& ports)
    : parts_(std::move(parts)), mass_(mass_matrix(*parts_.model, parts_.scheme.mass)) {
  state_.motion = std::move(parts_.motion);
  describe(std::move(name), ports);
  if (!ports_.empty()) {
    port_map_ = std::make_unique<PortMap>(*parts_.model, *parts_.map, ports_);
    std::unique_ptr<PortForces> forces = std::make_unique<PortForces>(*port_map_);
    port_forces_ = forces.get();
    const bool conserves = parts_.scheme.integrator->able().lag == nullptr;
    for (std::size_t p = 0; p < ports_.size(); ++p)
      if (joined_[p])
        port_forces_->join(p,
                           conserves ? massless_values(parts_.problem->model->massless(), ports_[p],
                                                       port_map_->first(p), description_.dim)
                                     : std::vector<std::size_t>(),
                           ports[p].alike);
    if (joins_) description_.can.kernel = true;
    description_.can.impulse = joins_ && !description_.quasi_static;
    places_.assign(port_map_->values(), 0.0);
    worked_.assign(ports_.size(), 0.0);
    left_ = before_ = now_ = seen_.u = state_.port_force = places_;
    change_.setZero(parts_.problem->model->dofs());
    parts_.problem->loads.push_back(std::move(forces));
    find_contacts();
  }
  find_traits();
  find_abilities();
}

void SolidInterior::find_traits() {
  const bool explicit_in_time = std::isfinite(description_.stable_step);
  for (const char joined : joined_) {
    traits_.support.push_back(joined != 0 ? ForceSupport::step : ForceSupport::nodal);
    traits_.reaction.push_back(description_.dim == 1 ? ForceSupport::nodal : ForceSupport::linear);
  }
  const std::string& words = parts_.scheme.words;
  traits_.scheme = words.substr(0, words.find(','));
  if (parts_.reduced != nullptr && parts_.rigid == nullptr)
    traits_.basis =
        std::array{"lumped", "averaged", "consistent"}[index(static_cast<int>(parts_.scheme.mass))];
  traits_.effort = parts_.model->mesh().cell_count() / usual_solid_work;
  // It may factor a large matrix.
  traits_.slow = !explicit_in_time && description_.dofs >= long_factorisation;
  // Let go of, material with a history would unload at a joined port: implicit bodies take the way
  // there by Newton's method or by a tangent that is not that of loading, and neither saves a call.
  traits_.looks_ahead = !joins_ || parts_.problem->model->history_size() == 0 || explicit_in_time;
}

void SolidInterior::find_abilities() {
  able_.successor = this;
  if (ports_.empty()) return;
  able_.probed = this;
  if (contact_) able_.obstructed = this;
  const Integrator::Abilities& scheme = parts_.scheme.integrator->able();
  if (scheme.foreseeing != nullptr && joins_ && !contact_) {
    forecast_ = std::make_unique<PortForecast>(state_.motion, *scheme.foreseeing, *port_map_,
                                               *port_forces_);
    able_.forecast = forecast_.get();
  }
  find_passive();
  if (scheme.statics == nullptr) return;
  statics_ = std::make_unique<PortStatics>(state_.motion, state_.time, *scheme.statics, *port_map_);
  able_.statics = statics_.get();
}

/// Ports without mass meet obstacles.
void SolidInterior::find_contacts() {
  if (description_.dim > 1) {
    find_surfaces();
    return watch_crossings();
  }
  const std::vector<int>& massless = parts_.problem->model->massless();
  std::vector<PointContact::Point> points;
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    const int dof = ports_[p].nodes.front();
    const PortGeometry& geometry = description_.ports[p].geometry;
    if (std::ranges::binary_search(massless, dof))
      points.push_back({p, dof, geometry.points[0], geometry.normals[0]});
  }
  if (points.empty()) return;
  contact_ = std::make_unique<PointContact>(points, description_.step, description_.name);
  port_forces_->keep_swings();
  // Joined ports meet none.
  const std::size_t joined = index(std::ranges::count(joined_, char{1}));
  description_.can.obstacle = points.size() + joined == ports_.size();
  description_.can.yielding = description_.can.obstacle;
}

void SolidInterior::find_surfaces() {
  // Where something may touch: of the undeformed body, at its first orientation.
  if (std::ranges::any_of(may_touch_, [](char touched) { return touched != 0; }))
    description_.can.kernel = true;
  std::vector<SurfaceContact::Surface> surfaces;
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    const std::vector<std::int32_t>& nodes = ports_[p].nodes;
    const PortGeometry& geometry = description_.ports[p].geometry;
    const FeModel& model = *parts_.model;
    const bool reduced = parts_.problem->model != &model;  // whose ports have mass
    if (geometry.facets.empty() || !may_touch_[p]) continue;
    const PortSurface port{p, port_map_->first(p), &geometry, nodes};
    touched_.push_back({port, ports_[p].name, model.options().thickness});
    if (reduced || parts_.massive_surface) continue;
    surfaces.push_back({port, {}, description_.stabilised});
    SurfaceContact::Surface& surface = surfaces.back();
    for (const std::int32_t node : nodes) surface.frames.push_back(model.frame(node));
  }
  for (std::string& name : touch_measure_names(touched_))
    description_.measures.push_back(std::move(name));
  if (!touched_.empty())
    for (FieldInfo& field : touch_fields(!surfaces.empty()))
      description_.fields.push_back(std::move(field));
  if (surfaces.empty()) return;
  std::optional<Interference> interference;
  if (parts_.pressed_over) interference.emplace(*parts_.pressed_over);
  auto contact = std::make_unique<SurfaceContact>(std::move(surfaces), description_.name,
                                                  std::move(interference));
  surfaces_ = contact.get();
  contact_ = std::move(contact);
  description_.can.obstacle = description_.can.yielding = description_.can.friction = true;
  description_.can.bands = true;
  description_.can.neighbours = joins_;
}

/// Whether a partner is there or not: a body may come upon itself alone.
void SolidInterior::watch_crossings() {
  if (!parts_.deforms || parts_.problem->model->is_linear()) return;
  std::vector<PortSurface> surfaces;
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    const PortGeometry& geometry = description_.ports[p].geometry;
    if (geometry.facets.empty() || joined_[p] || description_.ports[p].tied) continue;
    surfaces.push_back({p, port_map_->first(p), &geometry, ports_[p].nodes});
  }
  if (surfaces.empty()) return;
  crossings_ = std::make_unique<SelfCrossings>(surfaces);
  description_.measures.emplace_back("contact.crossings");
}

void SolidInterior::describe(std::string name, const std::vector<PortNodes>& ports) {
  const Mesh& mesh = parts_.model->mesh();
  description_.name = std::move(name);
  std::string cells;
  for (const CellBlock& block : mesh.blocks)
    cells +=
        fmt::format("{}{} {}", cells.empty() ? "" : " and ", block.count(), block.element->name);
  description_.model = fmt::format("{}, {}, {}", parts_.rung, cells, parts_.scheme.words);
  description_.dim = mesh.dim;
  description_.dofs = parts_.problem->model->dofs();
  description_.mass = parts_.model->material().density() * parts_.model->volume();
  description_.step = parts_.scheme.step;
  const Integrator::Abilities& scheme = parts_.scheme.integrator->able();
  description_.quasi_static = scheme.statics != nullptr;
  description_.loose = parts_.loose;
  description_.stabilised = stabilised();
  description_.stable_step = parts_.scheme.stable_step;
  description_.can.force = true;
  const bool small = parts_.problem->model->is_linear() && parts_.deforms;
  description_.linear = small;
  description_.can.kernel = (small || mesh.dim == 1) && scheme.inertia != nullptr && !ports.empty();
  for (const PortNodes& p : ports) {
    ports_.push_back({p.name, mesh.nodes_of(p.side), p.inside.rows});
    may_touch_.push_back(p.touched);
    joined_.push_back(p.joined);
    joins_ = joins_ || p.joined;
    Port port{p.name, port_geometry(*parts_.model, p.side, ports_.back().nodes), p.tied};
    add_to(p.inside, port.geometry);
    if (parts_.deforms) port.geometry.transit = port.geometry.spacing / fastest_wave(*parts_.model);
    description_.ports.push_back(std::move(port));
  }
  description_.measures = solid_measure_names(mesh.dim, parts_.deforms, ports_);
  const auto also = [this](const std::vector<std::string>& names) {
    description_.measures.insert(description_.measures.end(), names.begin(), names.end());
  };
  also(reaction_measure_names(mesh.dim, parts_.constraints));
  if (scheme.held != nullptr) also(StableSteps::measure_names());
  also(validity_measure_names(*parts_.model, parts_.deforms));
  if (stabilised()) also(stabilisation_measure_names(mesh.dim));
  description_.columns = reaction_columns(mesh.dim, parts_.constraints);
  description_.frequencies = parts_.frequencies;
  description_.fields = solid_fields(parts_.model->material(), parts_.deforms);
  if (parts_.reactions) description_.fields.push_back({"reaction", FieldPlace::nodes, 3});
}

void SolidInterior::state(Archive& archive) {
  state_of_motion(archive);
  if (surfaces_ != nullptr) surfaces_->state(archive);
  if (parts_.problem->model->is_linear()) return;
  MasslessLayer* layer = parts_.scheme.integrator->able().layer;
  if (layer != nullptr && !layer->empty()) return layer->state(archive);
  std::vector<double> none;  // statics have no layer; stages after them may
  archive.field("layer_place", none);
}

void SolidInterior::state_of_motion(Archive& archive) {
  archive.field("time", state_.time);
  state_.motion.state(archive);
  archive.field("begun", state_.begun);
  archive.field("port_force", state_.port_force);
  archive.field("port_work", state_.port_work);
  archive.field("light_mean", state_.light.mean);
  archive.field("light_end", state_.light.end);
  archive.field("turned", state_.turned);
  if (crossings_) archive.field("crossed", state_.crossed);
}

std::optional<Failed> SolidInterior::begin(const Window& window) {
  const double time = window.request.window.begin;
  worked_.assign(ports_.size(), 0.0);
  if (const bool instant = window.grid.count == 0; std::exchange(stands_, instant && stands_)) {
    if (port_map_) port_map_->displacement(state_.motion.q, places_);
    if (instant) return std::nullopt;  // nobody gives the forces yet that hold it
  }
  if (description_.dim == 1) {  // of the window's begin, which is accepted
    see_nodes();
    std::optional<Failed> failed =
        compressed_to_nothing(u_, parts_.model->mesh(), time, description_.name);
    if (failed) return failed;
  }
  if (port_forces_ != nullptr) {
    port_forces_->impose(window.request.boundary, window.grid, state_.light);
    port_forces_->enter(1);
  }
  substep_ = 0;
  if (contact_) contact_->impose(window);
  parts_.problem->contact = contact_ && contact_->acts() ? contact_.get() : nullptr;
  if (parts_.problem->contact != nullptr) port_map_->displacement(state_.motion.q, left_);
  if (std::optional<Failed> failed = meet_port_forces(time)) return failed;
  if (parts_.problem->contact != nullptr) contact_->aim(0, state_.port_force, left_);
  if (!state_.begun) {
    const bool without_ties =
        port_forces_ != nullptr && parts_.scheme.integrator->able().accelerates_without_ties;
    if (without_ties) port_forces_->enter(0);
    parts_.problem->set_rates(time, parts_.scheme.step, state_.motion);
    if (std::optional<Failed> failed = parts_.scheme.integrator->begin(state_.motion, time))
      return failed;
    if (without_ties) port_forces_->enter(1);
    state_.begun = true;
    state_.time = time;
  }
  if (port_map_) port_map_->displacement(state_.motion.q, places_);
  return swapped_ ? settle_swap() : std::nullopt;
}

void SolidInterior::restored() {
  if (is_passive()) start_passive();  // its energy asks for it
  if (port_map_) port_map_->displacement(state_.motion.q, places_);
}

std::optional<Failed> SolidInterior::step(const Window& window, int i, bool) {
  Integrator& integrator = *parts_.scheme.integrator;
  const double begin = window.grid.time(i - 1), dt = window.grid.length(i);
  substep_ = i;
  if (i > 1) left_ = places_;
  if (joins_ && i > 1) {  // forces of joined sides jump
    port_forces_->enter(i);
    if (std::optional<Failed> failed = meet_port_forces(begin)) return failed;
  }
  // Slip is counted from where the surface was: what has no mass jumps with forces of joined sides.
  if (parts_.problem->contact != nullptr) contact_->aim(i, state_.port_force, left_);
  if (!description_.loose.empty()) {
    const std::span<const double> carry = window.request.carry;
    const std::size_t each = index(loose_motions(description_));
    integrator.able().statics->carry_to(carry.empty() ? carry
                                                      : carry.subspan(index(i - 1) * each, each));
  }
  const double beside = 1.0 - dt / parts_.scheme.step;  // of whole steps 0 to the last bit
  shift_lag(beside);
  if (std::optional<Failed> failed = integrator.step(state_.motion, begin, dt)) return failed;
  state_.time = window.grid.time(i);
  if (port_map_) follow_ports(state_.time);
  shift_lag(-beside);
  if (i < window.grid.count) return std::nullopt;
  // Passive forms take no cell that is crushed already. In more dimensions cells are not looked at:
  // it would cost as much as their forces.
  if (description_.dim == 1 && parts_.problem->contact != nullptr &&
      parts_.model->least_volume(state_.motion.q) < crushed)
    return failed_newton({NewtonReport::End::inadmissible}, state_.time);
  return meet_end();
}

bool SolidInterior::stabilised() const {
  const QuasiStatic* statics = parts_.scheme.integrator->able().statics;
  return statics != nullptr && statics->stabilisation() != nullptr;
}

/// Where the nodes are and how they move now.
void SolidInterior::see_nodes() {
  u_.resize(nodal_values());
  v_.resize(nodal_values());
  parts_.map->displacement(state_.motion.q, u_);
  parts_.map->velocity(state_.motion.q, state_.motion.v, v_);
  momentum_.noalias() = mass_of_form() * view(v_);
  parts_.model->to_space(u_);
  parts_.model->to_space(v_);
  parts_.model->to_space({momentum_.data(), nodal_values()});
  add_lag();
}

/// Partners see a port without mass where the force of the instant holds it; the body is moved by
/// the mean.
void SolidInterior::see_places() {
  seen_.u = places_;
  for (std::size_t p = 0; contact_ && description_.dim == 1 && p < ports_.size(); ++p) {
    const double swing = contact_->has(p) ? port_forces_->swing(substep_, p) : 0.0;
    if (swing != 0.0) seen_.u[p] += compliance(p) * swing;
  }
}

const PortValues& SolidInterior::see(const Window&, double time, bool all) {
  if (!port_map_) return seen_;
  see_places();
  if (!all) return seen_;
  const Motion& motion = state_.motion;
  port_map_->velocity(motion.q, motion.v, seen_.v);
  port_map_->acceleration(motion.q, motion.v, motion.a, seen_.a);
  port_forces_->at(time, seen_.f);
  for (std::size_t p = 0; contact_ && p < ports_.size(); ++p) {
    if (!contact_->acts(p)) continue;
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(port_map_->first(p));
    std::copy_n(state_.port_force.begin() + first, port_map_->width(p), seen_.f.begin() + first);
  }
  return seen_;
}

void SolidInterior::react(std::size_t port, std::size_t partner, std::vector<double>& force) const {
  contact_->react(port, partner, state_.port_force, force);
}

std::string SolidInterior::misfit(int port, const PortKernel& kernel) const {
  return contact_->misfit(index(port), kernel);
}

double SolidInterior::compliance(std::size_t port) const {
  if (description_.dim > 1 || !contact_ || !contact_->has(port)) return 0.0;
  const Motion& motion = state_.motion;
  MasslessLayer* layer = parts_.scheme.integrator->able().layer;
  if (layer == nullptr) return 0.0;
  return layer->compliance(motion.q, motion.history, ports_[port].nodes.front());
}

std::optional<Failed> SolidInterior::record(BodyRecord& r) {
  see_nodes();
  r.energy = energy();
  state_.turned = std::max(state_.turned, rotation_on_the_way(*parts_.model, parts_.deforms, u_));
  if (crossings_)
    state_.crossed = std::max(state_.crossed, static_cast<double>(crossings_->count(places_)));
  r.momentum.assign(index(description_.dim), 0.0);
  for (Eigen::Index k = 0; k < momentum_.size(); ++k)
    r.momentum[index(k) % r.momentum.size()] += momentum_(k);
  angular_momentum(parts_.model->mesh(), u_, momentum_, r.angular_momentum);
  reactions(r.columns);
  return std::nullopt;
}

std::vector<double> SolidInterior::measure() {
  see_nodes();
  std::vector<double> q(nodal_values());
  parts_.map->displacement(state_.motion.q, q);
  std::vector<double> out = solid_measures(
      *parts_.model, {parts_.deforms, q, v_, state_.motion.history, energy(), momentum_}, ports_);
  std::vector<double> sums;
  reactions(sums);
  const StableSteps* held = parts_.scheme.integrator->able().held;
  for (const std::vector<double>& more :
       {reaction_measures(description_.dim, sums),
        held != nullptr ? held->measure(state_.motion) : std::vector<double>{},
        validity_measures(*parts_.model, parts_.deforms, u_, state_.motion.stored, state_.turned)})
    out.insert(out.end(), more.begin(), more.end());
  if (stabilised()) {
    const std::vector<double> more = stabilisation_measures(
        *parts_.model, *parts_.scheme.integrator->able().statics, state_.motion);
    out.insert(out.end(), more.begin(), more.end());
  }
  touch_measures(touched_, surfaces_, state_.port_force, places_, out);
  if (crossings_) out.push_back(state_.crossed);
  return out;
}

Grid SolidInterior::grid() { return grid_of(parts_.model->mesh()); }

std::vector<FieldValues> SolidInterior::fields() {
  see_nodes();
  std::vector<double> q(nodal_values());
  parts_.map->displacement(state_.motion.q, q);
  std::vector<double> history = state_.motion.history;
  history.resize(parts_.model->history_size(), 0.0);  // before the first advance there is none
  std::vector<FieldValues> values =
      solid_field_values(*parts_.model, {q, u_, v_, history}, parts_.deforms);
  if (parts_.reactions) values.push_back(nodal_reactions());
  if (touched_.empty()) return values;
  for (FieldValues& field :
       touch_field_values(touched_, surfaces_, index(parts_.model->mesh().node_count()),
                          state_.port_force, places_))
    values.push_back(std::move(field));
  return values;
}

Energy SolidInterior::energy() const {
  const Motion& motion = state_.motion;
  const double rubbed = surfaces_ != nullptr ? surfaces_->dissipated() : 0.0;
  const double kinetic = is_passive() ? moving_energy() : parts_.scheme.integrator->kinetic(motion);
  const double pressed_in = surfaces_ != nullptr ? surfaces_->pressed_in() : 0.0;
  double ahead = 0.0;
  if (parts_.rigid != nullptr && !is_passive() && !state_.port_force.empty()) {
    change_.setZero(parts_.rigid->dofs());
    port_map_->lift(motion.q, state_.port_force, change_);
    ahead = kicked_ahead(*parts_.rigid, motion, change_);
  }
  return {kinetic - ahead, motion.stored, motion.dissipated + rubbed,
          // partners account for what ports exchange
          motion.external_work + pressed_in - state_.port_work - ahead};
}

/// A hint, which the horizon's flight verifies: waves inside may yet throw the surface faster.
void SolidInterior::finish(std::size_t port, PortResponse& reply) const {
  reply.work = worked_[port];
  if (description_.dim == 1) return;
  for (std::size_t k = 0; surfaces_ != nullptr && k < reply.reactions.size(); ++k)
    surfaces_->finish(port, k, reply.reactions[k]);
  const std::size_t dim = index(description_.dim);
  const double* v = seen_.v.data() + port_map_->first(port);
  double most = 0.0;
  for (std::size_t k = 0; k < port_map_->width(port); k += dim) {
    double square = 0.0;
    for (std::size_t i = 0; i < dim; ++i) square += v[k + i] * v[k + i];
    most = std::max(most, square);
  }
  reply.speed_bound = std::sqrt(most);
  reply.acceleration_bound = parts_.body_acceleration ? parts_.body_acceleration(state_.time) : 0.0;
}

}  // namespace abut
