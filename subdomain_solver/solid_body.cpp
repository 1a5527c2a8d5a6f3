#include "subdomain_solver/solid_body.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/assert.hpp"
#include "base/error.hpp"
#include "subdomain_solver/fe/loads.hpp"
#include "subdomain_solver/saved_state.hpp"
#include "subdomain_solver/solid_fields.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

namespace {

/// Cell-steps between two signs of life: about 10 ms of work.
constexpr double progress_work = 1.0e3;

std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }

}  // namespace

/// Forces imposed on the ports, linear in time between the imposed instants.
class SolidBody::PortForces final : public Load {
 public:
  explicit PortForces(const SolidBody& body) : body_(body) {}

  void impose(const Advance* request) { request_ = request; }

  void add(double time, std::span<const double> q, Vector& force) const override {
    if (request_ == nullptr) return;
    for (std::size_t p = 0; p < body_.ports_.size(); ++p) {
      const std::vector<double> values = at(p, time);
      if (values.empty()) continue;
      const std::size_t dim = index(body_.description_.dim);
      Vector nodal = Vector::Zero(static_cast<Eigen::Index>(body_.nodal_values()));
      for (std::size_t k = 0; k < values.size(); ++k)
        nodal(static_cast<Eigen::Index>(index(body_.ports_[p].nodes[k / dim]) * dim + k % dim)) +=
            values[k];
      body_.parts_.model->to_frames({nodal.data(), index(nodal.size())});
      body_.parts_.map->lift(q, {nodal.data(), index(nodal.size())}, force);
    }
  }

  /// (n, dim) forces on a port at a time; empty: none imposed.
  std::vector<double> at(std::size_t port, double time) const {
    if (request_ == nullptr || request_->boundary.size() <= port) return {};
    const Waveform& imposed = request_->boundary[port].force;
    if (imposed.empty()) return {};
    std::vector<double> values(index(imposed.width));
    imposed.force_at(time, values);
    return values;
  }

 private:
  const SolidBody& body_;
  const Advance* request_ = nullptr;
};

SolidBody::SolidBody(std::string name, Parts parts, const std::vector<PortNodes>& ports)
    : parts_(std::move(parts)), mass_(mass_matrix(*parts_.model, parts_.scheme.mass)) {
  state_.motion = std::move(parts_.motion);
  describe(std::move(name), ports);
  if (!ports_.empty()) {
    std::unique_ptr<PortForces> forces = std::make_unique<PortForces>(*this);
    port_forces_ = forces.get();
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
  for (const PortNodes& p : ports) {
    ports_.push_back({p.name, mesh.nodes_of(p.side)});
    description_.ports.push_back(port_of(p, ports_.back().nodes));
  }
  description_.measures = solid_measure_names(mesh.dim, parts_.deforms, ports_);
  for (const std::string& measure : parts_.scheme.integrator->measure_names())
    description_.measures.push_back(measure);
  description_.fields = solid_fields(parts_.model->material(), parts_.deforms);
  lower_.resize(ports.size());
  upper_.resize(ports.size());
}

/// Points, facets and area-averaged normals of a side; a node set has no normals.
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
  if (port_forces_ != nullptr) port_forces_->impose(&request);
  const Substeps grid =
      Substeps::divide(request.window.begin, request.window.end, parts_.scheme.step);
  std::optional<Failed> failed = advance(request, grid, response);
  if (port_forces_ != nullptr) port_forces_->impose(nullptr);
  if (failed) return *failed;
  response.steps = grid.count;
  response.compute_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return Advanced{};
}

std::optional<Failed> SolidBody::advance(const Advance& request, const Substeps& grid,
                                         Response& response) {
  Integrator& integrator = *parts_.scheme.integrator;
  if (!state_.begun) {
    if (std::optional<Failed> failed = integrator.begin(state_.motion, request.window.begin))
      return failed;
    state_.begun = true;
  }
  for (PortResponse& port : response.ports) {
    port.trace.clear();
    port.trace.support = ForceSupport::nodal;
    port.rebound.reset();
    port.lower.clear();
    port.upper.clear();
    // Nothing is known of how fast a port may come: the coordinator goes window by window.
    port.approach_bound = std::numeric_limits<double>::infinity();
  }
  push_traces(request.window.begin, response);
  begin_sweep();
  RecordClock clock(request, grid.count);
  for (int i = 1; i <= grid.count; ++i) {
    const double before = i == 1 ? grid.begin : grid.time(i - 1);
    if (std::optional<Failed> failed = integrator.step(state_.motion, before, grid.length(i)))
      return failed;
    widen_sweep();
    report_progress();
    const bool due = i == clock.substep();
    if (request.sampling == Sampling::substeps)
      push_traces(grid.time(i), response);
    else if (due)
      push_traces(clock.time(), response);
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

std::vector<double> SolidBody::acceleration() const {
  std::vector<double> a(nodal_values());
  parts_.map->acceleration(state_.motion.q, state_.motion.v, state_.motion.a, a);
  parts_.model->to_space(a);
  return a;
}

void SolidBody::push_traces(double time, Response& response) const {
  if (ports_.empty()) return;
  const std::size_t dim = index(description_.dim);
  const std::vector<double> u = displacement(), v = velocity(), a = acceleration();
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    Waveform& trace = response.ports[p].trace;
    trace.width = static_cast<int>(ports_[p].nodes.size() * dim);
    trace.time.push_back(time);
    for (std::int32_t node : ports_[p].nodes) {
      const auto from = static_cast<std::ptrdiff_t>(index(node) * dim);
      const auto to = from + static_cast<std::ptrdiff_t>(dim);
      trace.u.insert(trace.u.end(), u.begin() + from, u.begin() + to);
      trace.v.insert(trace.v.end(), v.begin() + from, v.begin() + to);
      trace.a.insert(trace.a.end(), a.begin() + from, a.begin() + to);
    }
    std::vector<double> f = port_forces_->at(p, time);
    f.resize(index(trace.width), 0.0);
    trace.f.insert(trace.f.end(), f.begin(), f.end());
  }
}

void SolidBody::begin_sweep() {
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    lower_[p].assign(index(description_.dim), std::numeric_limits<double>::infinity());
    upper_[p].assign(index(description_.dim), -std::numeric_limits<double>::infinity());
  }
  widen_sweep();
}

void SolidBody::widen_sweep() {
  if (ports_.empty()) return;
  const std::size_t dim = index(description_.dim);
  const std::vector<double> u = displacement();
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    for (std::int32_t node : ports_[p].nodes) {
      for (std::size_t i = 0; i < dim; ++i) {
        lower_[p][i] = std::min(lower_[p][i], u[index(node) * dim + i]);
        upper_[p][i] = std::max(upper_[p][i], u[index(node) * dim + i]);
      }
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
  r.momentum.assign(index(description_.dim), 0.0);
  for (Eigen::Index k = 0; k < momentum.size(); ++k)
    r.momentum[index(k) % r.momentum.size()] += momentum(k);
  r.angular_momentum = angular_momentum(parts_.model->mesh(), displacement(), momentum);
  double sum = r.energy.total() + r.energy.external_work;
  for (double p : r.momentum) sum += p;
  for (double p : r.angular_momentum) sum += p;
  if (std::isfinite(sum)) return std::nullopt;
  return Failed{Failed::Cause::non_finite, time,
                "the state is not a number any more: take a smaller step"};
}

std::vector<double> SolidBody::measure() {
  std::vector<double> u(nodal_values());
  parts_.map->displacement(state_.motion.q, u);
  std::vector<double> out = solid_measures(
      *parts_.model,
      {parts_.deforms, u, velocity(), state_.motion.history, energy(), momentum_of_nodes()},
      ports_);
  const std::vector<double> more = parts_.scheme.integrator->measure(state_.motion);
  out.insert(out.end(), more.begin(), more.end());
  return out;
}

Grid SolidBody::grid() { return grid_of(parts_.model->mesh()); }

std::vector<FieldValues> SolidBody::fields() {
  std::vector<double> q(nodal_values());
  parts_.map->displacement(state_.motion.q, q);
  const std::vector<double> u = displacement(), v = velocity();
  return solid_field_values(*parts_.model, {q, u, v, state_.motion.history}, parts_.deforms);
}

Energy SolidBody::energy() const {
  const Motion& motion = state_.motion;
  return {parts_.scheme.integrator->kinetic(motion), motion.stored, motion.dissipated,
          motion.external_work};
}

PortKernel SolidBody::kernel(int, double, int) {
  throw RunError("has no port kernel", fmt::format("body '{}'", description_.name),
                 "Ask for kernels of bodies that offer them.");
}

void SolidBody::report_progress() {
  work_since_progress_ += parts_.model->mesh().cell_count();
  if (work_since_progress_ < progress_work) return;
  work_since_progress_ = 0.0;
  if (progress_) progress_();
}

}  // namespace abut
