#include "subdomain_solver/solid_body.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/life_signs.hpp"
#include "subdomain_solver/bars/compressed_bar.hpp"
#include "subdomain_solver/fe/loads.hpp"
#include "subdomain_solver/saved_state.hpp"
#include "subdomain_solver/solid_fields.hpp"
#include "subdomain_solver/time/motion_views.hpp"
#include "subdomain_solver/validity_measures.hpp"

namespace abut {

namespace {

/// Cell-steps between two signs of life: about 10 ms of work.
constexpr double progress_work = 1.0e3;

/// Degrees of freedom from which on a factorisation may take more than a moment.
constexpr std::int64_t long_factorisation = 30'000;
constexpr std::chrono::milliseconds life_interval{250};

/// Speed [m/s] of the fastest wave at the undeformed state: of dilatation, or along a bar.
double fastest_wave(const FeModel& model) {
  const Moduli moduli = model.material().moduli();
  const double stiffness = model.mesh().dim == 1 ? moduli.youngs() : moduli.p_wave();
  return std::sqrt(stiffness / model.material().density());
}

}  // namespace

SolidBody::SolidBody(std::string name, Parts parts, const std::vector<PortNodes>& ports)
    : parts_(std::move(parts)), mass_(mass_matrix(*parts_.model, parts_.scheme.mass)) {
  state_.motion = std::move(parts_.motion);
  describe(std::move(name), ports);
  if (!ports_.empty()) {
    port_map_ = std::make_unique<PortMap>(*parts_.model, *parts_.map, ports_);
    std::unique_ptr<PortForces> forces = std::make_unique<PortForces>(*port_map_);
    port_forces_ = forces.get();
    state_.port_force.assign(port_map_->values(), 0.0);
    parts_.problem->loads.push_back(std::move(forces));
  }
}

void SolidBody::describe(std::string name, const std::vector<PortNodes>& ports) {
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
  description_.stable_step = parts_.scheme.stable_step;
  description_.can.force = true;
  const bool linear = parts_.problem->model->is_linear() && (parts_.deforms || mesh.dim == 1);
  description_.can.kernel =
      linear && parts_.scheme.integrator->has_inertia() && !ports.empty();
  for (const PortNodes& p : ports) {
    ports_.push_back({p.name, mesh.nodes_of(p.side)});
    Port port = port_of(p, ports_.back().nodes);
    if (parts_.deforms) port.geometry.transit = port.geometry.spacing / fastest_wave(*parts_.model);
    description_.ports.push_back(std::move(port));
  }
  description_.measures = solid_measure_names(mesh.dim, parts_.deforms, ports_);
  const auto also = [this](const std::vector<std::string>& names) {
    description_.measures.insert(description_.measures.end(), names.begin(), names.end());
  };
  also(reaction_measure_names(mesh.dim, parts_.constraints));
  also(parts_.scheme.integrator->measure_names());
  also(validity_measure_names(*parts_.model, parts_.deforms));
  description_.columns = reaction_columns(mesh.dim, parts_.constraints);
  description_.frequencies = parts_.frequencies;
  description_.fields = solid_fields(parts_.model->material(), parts_.deforms);
  if (parts_.reactions) description_.fields.push_back({"reaction", FieldPlace::nodes, 3});
  lower_.resize(ports.size());
  upper_.resize(ports.size());
}

/// Points, facets and area-averaged normals of a side; a node set has no normals, the end of a bar
/// no facets.
Port SolidBody::port_of(const PortNodes& nodes, const std::vector<std::int32_t>& list) const {
  const Mesh& mesh = parts_.model->mesh();
  const std::size_t dim = index(mesh.dim);
  Port port;
  port.name = nodes.name;
  port.geometry.dim = mesh.dim;
  for (std::int32_t node : list) {
    const double* x = mesh.points.data() + index(node) * dim;
    port.geometry.points.insert(port.geometry.points.end(), x, x + dim);
  }
  port.geometry.normals.assign(list.size() * dim, 0.0);
  if (!mesh.sides.contains(nodes.side)) return port;
  std::vector<double>& normals = port.geometry.normals;
  port.geometry.offsets.push_back(0);
  double area = 0.0;
  const SidePoints side = SidePoints::of(*parts_.model, nodes.side);
  for (const SidePoints::FacetPoints& facet : side.facets) {
    for (std::size_t a = 0; a < facet.nodes.size(); ++a) {
      const auto place = std::lower_bound(list.begin(), list.end(), facet.nodes[a]) - list.begin();
      port.geometry.facets.push_back(static_cast<std::int32_t>(place));
      for (const SidePoints::Point& point : facet.points) {
        for (std::size_t i = 0; i < dim; ++i)
          normals[index(place) * dim + i] +=
              point.area * point.n[a] * point.normal(static_cast<Eigen::Index>(i));
      }
    }
    port.geometry.offsets.push_back(static_cast<std::int32_t>(port.geometry.facets.size()));
    for (const SidePoints::Point& point : facet.points) area += point.area;
  }
  for (std::size_t k = 0; k < normals.size(); k += dim) {
    double length = 0.0;
    for (std::size_t i = 0; i < dim; ++i) length = std::hypot(length, normals[k + i]);
    for (std::size_t i = 0; i < dim && length > 0.0; ++i) normals[k + i] /= length;
  }
  if (dim == 1) {
    port.geometry.facets.clear();
    port.geometry.offsets.clear();
    const Facet& end = mesh.side(nodes.side).front();
    const CellBlock& cells = mesh.blocks[index(end.block)];
    const std::int32_t* cell = cells.nodes.data() + end.cell * cells.element->nodes;
    port.geometry.spacing = mesh.points[index(cell[1])] - mesh.points[index(cell[0])];
    return port;
  }
  const double facets = static_cast<double>(std::max<std::size_t>(1, side.facets.size()));
  port.geometry.spacing =
      std::pow(area / facets, 1.0 / std::max(1.0, static_cast<double>(dim) - 1.0));
  return port;
}

void SolidBody::save() { save_state(state_, saved_); }

void SolidBody::restore() { restore_state(state_, saved_); }

std::vector<std::byte> SolidBody::checkpoint() { return checkpoint_of(state_); }

void SolidBody::resume(std::span<const std::byte> bytes) {
  State resumed = state_of_checkpoint<State>(bytes);
  if (resumed.motion.q.size() != state_.motion.q.size()) {
    throw RunError(fmt::format("the checkpoint holds {} coordinates, but the body has {}",
                               resumed.motion.q.size(), state_.motion.q.size()),
                   fmt::format("body '{}'", description_.name),
                   "Resume with the mesh that wrote the checkpoint.");
  }
  state_ = std::move(resumed);
}

Outcome SolidBody::finish(Response& response) {
  ABUT_ASSERT(request_ != nullptr);
  const Advance& request = *request_;
  request_ = nullptr;
  const auto began = std::chrono::steady_clock::now();
  response.records.resize(index(std::max(1, request.records)));
  response.ports.resize(ports_.size());
  recorded_ = 0;
  if (description_.dim == 1) {  // of the window's begin, which is accepted
    std::optional<Failed> failed = compressed_to_nothing(displacement(), parts_.model->mesh(),
                                                         request.window.begin, description_.name);
    if (failed) return *failed;
  }
  const Substeps grid =
      Substeps::divide(request.window.begin, request.window.end, parts_.scheme.step);
  if (port_forces_ != nullptr) port_forces_->impose(request.boundary, grid);
  std::optional<Failed> failed = advance(request, grid, response);
  if (failed) return *failed;
  response.steps = grid.count;
  response.compute_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return Advanced{};
}

std::optional<Failed> SolidBody::advance(const Advance& request, const Substeps& grid,
                                         Response& response) {
  Integrator& integrator = *parts_.scheme.integrator;
  meet_port_forces(request.window.begin);
  if (!state_.begun) {
    parts_.problem->set_rates(request.window.begin, parts_.scheme.step, state_.motion);
    const double begin = request.window.begin;
    if (std::optional<Failed> failed =
            patiently([&] { return integrator.begin(state_.motion, begin); }))
      return failed;
    state_.begun = true;
    state_.time = begin;
  }
  for (PortResponse& port : response.ports) {
    port.trace.clear();
    port.trace.support = ForceSupport::nodal;
    port.recoil.reset();
    port.work = 0.0;
    port.lower.clear();
    port.upper.clear();
    port.reactions.clear();
    port.acceleration_bound = 0.0;
    // Nothing is known of how fast a port may come: the coordinator goes window by window.
    port.speed_bound = std::numeric_limits<double>::infinity();
  }
  see_ports();
  push_traces(request, request.window.begin, response);
  begin_sweep();
  RecordClock clock(request, grid.count);
  for (int i = 1; i <= grid.count; ++i) {
    const double before = i == 1 ? grid.begin : grid.time(i - 1);
    if (std::optional<Failed> failed =
            patiently([&] { return integrator.step(state_.motion, before, grid.length(i)); }))
      return failed;
    state_.time = grid.time(i);
    follow_ports(state_.time);
    report_progress();
    const bool due = i == clock.substep();
    if (request.sampling == Sampling::substeps)
      push_traces(request, grid.time(i), response);
    else if (due)
      push_traces(request, clock.time(), response);
    for (; i == clock.substep(); clock.next()) {
      if (std::optional<Failed> failed = record(clock.time(), response)) return failed;
    }
  }
  for (; !clock.done(); clock.next()) {  // a window of no length
    if (std::optional<Failed> failed = record(clock.time(), response)) return failed;
  }
  return std::nullopt;
}

/// Of the nodes (nodes, dim), along the axes of space [m].
std::vector<double> SolidBody::displacement() const {
  std::vector<double> u(nodal_values());
  parts_.map->displacement(state_.motion.q, u);
  parts_.model->to_space(u);
  return u;
}

std::vector<double> SolidBody::velocity() const {
  std::vector<double> v(nodal_values());
  parts_.map->velocity(state_.motion.q, state_.motion.v, v);
  parts_.model->to_space(v);
  return v;
}

void SolidBody::push_traces(const Advance& request, double time, Response& response) const {
  if (ports_.empty()) return;
  const Motion& motion = state_.motion;
  std::vector<double> v, a;
  port_map_->velocity(motion.q, motion.v, v);
  port_map_->acceleration(motion.q, motion.v, motion.a, a);
  const std::vector<double> f = port_forces_->at(time);
  const std::size_t dim = index(description_.dim);
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    const Want want = request.want.empty() ? Want{} : request.want[p];
    Waveform& trace = response.ports[p].trace;
    const std::size_t points = want.points.empty() ? ports_[p].nodes.size() : want.points.size();
    trace.points = want.points;
    trace.width = static_cast<int>(points * dim);
    trace.time.push_back(time);
    const auto add = [this, p, dim, &trace](bool wanted, const std::vector<double>& from,
                                            std::vector<double>& to) {
      if (!wanted) return;
      const double* first = from.data() + port_map_->first(p);
      if (trace.points.empty()) to.insert(to.end(), first, first + trace.width);
      for (std::int32_t point : trace.points)
        to.insert(to.end(), first + index(point) * dim, first + (index(point) + 1) * dim);
    };
    add(want.u, port_displacement_, trace.u);
    add(want.v, v, trace.v);
    add(want.a, a, trace.a);
    add(want.f, f, trace.f);
  }
}

/// Forces on ports begin and end between windows: accelerations follow at once.
void SolidBody::meet_port_forces(double time) {
  if (port_forces_ == nullptr) return;
  std::vector<double> now = port_forces_->at(time);
  if (state_.begun && now != state_.port_force) {
    std::vector<double> change = now;
    for (std::size_t k = 0; k < change.size(); ++k) change[k] -= state_.port_force[k];
    Vector force = Vector::Zero(parts_.problem->model->dofs());
    port_map_->lift(state_.motion.q, change, force);
    parts_.scheme.integrator->jump(state_.motion, force);
  }
  state_.port_force = std::move(now);
}

void SolidBody::see_ports() {
  if (!ports_.empty()) port_map_->displacement(state_.motion.q, port_displacement_);
}

/// After a substep: where the ports are, and the work that the forces on them have done.
void SolidBody::follow_ports(double time) {
  if (ports_.empty()) return;
  const std::vector<double> before = port_displacement_;
  see_ports();
  widen_sweep();
  if (!port_forces_->acts()) return;
  const std::vector<double> now = port_forces_->at(time);
  for (std::size_t k = 0; k < now.size(); ++k)
    state_.port_work += 0.5 * (state_.port_force[k] + now[k]) * (port_displacement_[k] - before[k]);
  state_.port_force = now;
}

void SolidBody::begin_sweep() {
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    lower_[p].assign(index(description_.dim), std::numeric_limits<double>::infinity());
    upper_[p].assign(index(description_.dim), -std::numeric_limits<double>::infinity());
  }
  widen_sweep();
}

/// By the places of the points.
void SolidBody::widen_sweep() {
  const std::size_t dim = index(description_.dim);
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    const double* u = port_displacement_.data() + port_map_->first(p);
    const std::vector<double>& x = description_.ports[p].geometry.points;
    for (std::size_t k = 0; k < x.size(); ++k) {
      lower_[p][k % dim] = std::min(lower_[p][k % dim], x[k] + u[k]);
      upper_[p][k % dim] = std::max(upper_[p][k % dim], x[k] + u[k]);
    }
  }
}

void SolidBody::end_sweep(Response& response) const {
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    PortResponse& port = response.ports[p];
    port.lower.insert(port.lower.end(), lower_[p].begin(), lower_[p].end());
    port.upper.insert(port.upper.end(), upper_[p].begin(), upper_[p].end());
  }
}

/// Momentum of each node (nodes, dim) along the axes of space.
Vector SolidBody::momentum_of_nodes() const {
  std::vector<double> v(nodal_values());
  parts_.map->velocity(state_.motion.q, state_.motion.v, v);
  Vector momentum = mass_ * view(v);
  parts_.model->to_space({momentum.data(), index(momentum.size())});
  return momentum;
}

std::optional<Failed> SolidBody::record(double time, Response& response) {
  end_sweep(response);
  begin_sweep();
  BodyRecord& r = response.records[recorded_++];
  r.time = time;
  r.energy = energy();
  const Vector momentum = momentum_of_nodes();
  const std::vector<double> u = displacement();
  state_.turned = std::max(state_.turned, rotation_on_the_way(*parts_.model, parts_.deforms, u));
  r.momentum.assign(index(description_.dim), 0.0);
  for (Eigen::Index k = 0; k < momentum.size(); ++k)
    r.momentum[index(k) % r.momentum.size()] += momentum(k);
  r.angular_momentum = angular_momentum(parts_.model->mesh(), u, momentum);
  r.columns = reactions();
  double sum = r.energy.total() + r.energy.external_work;
  for (const std::vector<double>* told : {&r.momentum, &r.angular_momentum, &r.columns})
    sum = std::accumulate(told->begin(), told->end(), sum);
  if (std::isfinite(sum)) return std::nullopt;
  return not_finite(time);
}

/// Forces on ports now, as those of nodes (nodes, dim) in their own frames [N].
Vector SolidBody::forces_on_ports() const {
  Vector all = Vector::Zero(static_cast<Eigen::Index>(nodal_values()));
  if (port_forces_ == nullptr || !port_forces_->acts()) return all;
  const std::vector<double> values = port_forces_->at(state_.time);
  std::size_t k = 0;
  for (const NamedNodes& port : ports_) {
    for (std::int32_t node : port.nodes) {
      for (int i = 0; i < description_.dim; ++i) all(node * description_.dim + i) += values[k++];
    }
  }
  parts_.model->to_frames({all.data(), nodal_values()});
  return all;
}

/// [N] (constraints, dim) along the axes of space; none before the begin.
std::vector<double> SolidBody::reactions() const {
  if (!parts_.reactions) return {};
  if (!state_.begun) return std::vector<double>(description_.columns.size(), 0.0);
  return parts_.reactions->sums(state_.motion, state_.time, forces_on_ports());
}

std::vector<double> SolidBody::measure() {
  std::vector<double> u(nodal_values());
  parts_.map->displacement(state_.motion.q, u);
  std::vector<double> out = solid_measures(
      *parts_.model,
      {parts_.deforms, u, velocity(), state_.motion.history, energy(), momentum_of_nodes()},
      ports_);
  for (const std::vector<double>& more :
       {reaction_measures(description_.dim, reactions()),
        parts_.scheme.integrator->measure(state_.motion),
        validity_measures(*parts_.model, parts_.deforms, displacement(), state_.motion.stored,
                          state_.turned)})
    out.insert(out.end(), more.begin(), more.end());
  return out;
}

Grid SolidBody::grid() { return grid_of(parts_.model->mesh()); }

std::vector<FieldValues> SolidBody::fields() {
  std::vector<double> q(nodal_values());
  parts_.map->displacement(state_.motion.q, q);
  const std::vector<double> u = displacement(), v = velocity();
  std::vector<FieldValues> values =
      solid_field_values(*parts_.model, {q, u, v, state_.motion.history}, parts_.deforms);
  if (!parts_.reactions) return values;
  Vector forces = Vector::Zero(static_cast<Eigen::Index>(nodal_values()));
  if (state_.begun)
    forces = parts_.reactions->forces(state_.motion, state_.time, forces_on_ports());
  parts_.model->to_space({forces.data(), nodal_values()});
  values.push_back(in_space(span_of(forces), description_.dim));
  return values;
}

Energy SolidBody::energy() const {
  const Motion& motion = state_.motion;
  return {parts_.scheme.integrator->kinetic(motion), motion.stored, motion.dissipated,
          motion.external_work - state_.port_work};  // partners account for what ports exchange
}

/// Displacement (substeps, values) of a port at the ends of substeps, from rest under the forces
/// that are imposed [m].
std::vector<double> SolidBody::respond_from_rest(std::size_t port, const Substeps& grid) {
  Integrator& integrator = *parts_.scheme.integrator;
  Motion& motion = state_.motion;
  const std::size_t coordinates = motion.q.size(), rates = motion.v.size();
  motion = Motion{};
  motion.q.assign(coordinates, 0.0);
  motion.v.assign(rates, 0.0);
  std::vector<double> displacement;
  std::optional<Failed> failed = integrator.begin(motion, 0.0);
  for (int i = 1; i <= grid.count && !failed; ++i) {
    failed = integrator.step(motion, grid.time(i - 1), grid.step);
    see_ports();
    const double* first = port_displacement_.data() + port_map_->first(port);
    const std::size_t width = description_.ports[port].geometry.points.size();
    displacement.insert(displacement.end(), first, first + width);
  }
  if (!failed) return displacement;
  throw RunError("has no port kernel: " + failed->detail,
                 fmt::format("body '{}'", description_.name),
                 "Give the body inertia or supports that hold it.");
}

PortKernel SolidBody::probe(int port, std::span<const double> patterns, double step, int count) {
  ABUT_ASSERT(description_.can.kernel && port >= 0 && index(port) < ports_.size() && step > 0.0);
  const State kept = state_;
  Problem& problem = *parts_.problem;
  Problem alone{problem.model, problem.supports, {}};  // with supports at rest, no other loads
  for (Prescribed& support : alone.supports) support.value = [](double) { return 0.0; };
  alone.loads.push_back(std::move(problem.loads.back()));
  problem.loads.pop_back();
  std::swap(problem, alone);
  const Substeps grid{0.0, count * step, step, step, count};
  const std::size_t width = description_.ports[index(port)].geometry.points.size();
  PortKernel kernel;
  kernel.step = step;
  kernel.width = static_cast<int>(width);
  kernel.patterns = static_cast<int>(patterns.size() / width);
  kernel.displacement.assign(index(count) * patterns.size(), 0.0);
  kernel.begin = kernel.displacement;
  for (std::size_t first = 0; first < patterns.size(); first += width) {
    std::vector<double> force(port_map_->values(), 0.0);
    const std::vector<double> none = force;
    std::copy_n(patterns.data() + first, width, force.data() + port_map_->first(index(port)));
    for (const bool at_begin : {false, true}) {
      port_forces_->impose(at_begin ? force : none, at_begin ? none : force, grid);
      const std::vector<double> moved = respond_from_rest(index(port), grid);
      std::vector<double>& to = at_begin ? kernel.begin : kernel.displacement;
      for (std::size_t k = 0; k < moved.size(); ++k)
        to[k / width * patterns.size() + first + k % width] = moved[k];
    }
  }
  std::swap(problem, alone);
  problem.loads.push_back(std::move(alone.loads.back()));
  state_ = kept;
  return kernel;
}

/// What may factor a large matrix, with signs of life meanwhile.
std::optional<Failed> SolidBody::patiently(
    const std::function<std::optional<Failed>()>& call) const {
  const bool factors = std::isinf(description_.stable_step);
  if (!progress_ || !factors || description_.dofs < long_factorisation) return call();
  LifeSigns life(progress_, life_interval);
  std::optional<Failed> outcome = call();
  life.end();
  return outcome;
}

void SolidBody::report_progress() {
  work_since_progress_ += parts_.model->mesh().cell_count();
  if (work_since_progress_ < progress_work) return;
  work_since_progress_ = 0.0;
  if (progress_) progress_();
}

}  // namespace abut
