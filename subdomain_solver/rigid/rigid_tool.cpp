#include "subdomain_solver/rigid/rigid_tool.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/index.hpp"
#include "subdomain_solver/port_geometry.hpp"
#include "subdomain_solver/solid_fields.hpp"

namespace abut {

RigidTool::RigidTool(std::string name, std::unique_ptr<FeModel> shape, std::vector<Way> way,
                     double step, const std::vector<SolidInterior::PortNodes>& ports,
                     const std::string& words)
    : shape_(std::move(shape)), way_(std::move(way)) {
  const Mesh& mesh = shape_->mesh();
  description_.name = std::move(name);
  description_.model = words;
  description_.dim = mesh.dim;
  description_.mass = std::numeric_limits<double>::infinity();
  description_.step = step;
  description_.stable_step = std::numeric_limits<double>::infinity();
  description_.linear = true;
  description_.can.force = description_.can.passive = true;
  able_.passive = this;
  std::size_t values = 0;
  for (const SolidInterior::PortNodes& p : ports) {
    Port port{p.name, port_geometry(*shape_, p.side, mesh.nodes_of(p.side)), p.tied};
    values += port.geometry.points.size();
    description_.ports.push_back(std::move(port));
  }
  constexpr const char* axes = "xyz";
  for (int i = 0; i < mesh.dim; ++i)
    description_.measures.push_back(fmt::format("displacement.{}", axes[i]));
  for (int i = 0; i < mesh.dim; ++i)
    description_.measures.push_back(fmt::format("force.{}", axes[i]));
  description_.fields = {{"displacement", FieldPlace::nodes, 3},
                         {"velocity", FieldPlace::nodes, 3}};
  seen_.u.assign(values, 0.0);
  seen_.v = seen_.a = seen_.f = seen_.u;
  const std::vector<double> zero(way_.size(), 0.0);
  state_ = {0.0, zero, zero, 0.0, zero};
}

void RigidTool::state(Archive& archive) {
  archive.field("time", state_.time);
  archive.field("place", state_.place);
  archive.field("force", state_.force);
  archive.field("work", state_.work);
  archive.field("velocity", state_.velocity);
}

std::optional<Failed> RigidTool::begin(const Window& window) {
  return move_to(window, window.request.window.begin);
}

std::optional<Failed> RigidTool::step(const Window& window, int i, bool) {
  return move_to(window, window.grid.time(i));
}

/// [N] (dim) mean of the partners' forces since the last step.
void RigidTool::mean_force(const Window& window, double time, std::vector<double>& mean) {
  mean.assign(way_.size(), 0.0);
  const double length = time - state_.time;
  if (length <= 0.0) return;
  for (const BoundaryData& boundary : window.request.boundary) {
    for (const Waveform& imposed : boundary.forces) {
      if (imposed.empty()) continue;
      imposed_.resize(index(imposed.width));
      imposed.impulse(state_.time, time, imposed_);
      for (std::size_t k = 0; k < imposed_.size(); ++k)
        mean[k % mean.size()] += imposed_[k] / length;
    }
  }
}

/// Between its steps the tool moves evenly, as its trace tells, so that partners' forces do the
/// work of their impulse, whatever they do meanwhile.
std::optional<Failed> RigidTool::move_to(const Window& window, double time) {
  see(window, time, true);  // for the forces
  std::vector<double> force(way_.size(), 0.0), mean;
  for (std::size_t k = 0; pushed_ && k < seen_.f.size(); k += way_.size())
    for (std::size_t i = 0; i < way_.size(); ++i) force[i] += seen_.f[k + i];
  mean_force(window, time, mean);
  if (std::optional<Failed> failed = go_to(time, mean)) return failed;
  state_.force = force;
  return std::nullopt;
}

/// Against a mean force [N] (dim) on the way.
std::optional<Failed> RigidTool::go_to(double time, const std::vector<double>& mean) {
  const double length = time - state_.time;
  for (std::size_t i = 0; i < way_.size(); ++i) {
    const double place = way_[i](time);
    if (!std::isfinite(place)) {
      return Failed{Failed::Cause::non_finite, time,
                    "the way of the tool has no value: check its expression"};
    }
    const double moved = place - state_.place[i];
    state_.work -= mean[i] * moved;
    if (length > 0.0) state_.velocity[i] = moved / length;
    state_.place[i] = place;
  }
  state_.time = time;
  return std::nullopt;
}

/// A tool that has not begun yet goes to where its way begins; one that cannot tells so in a step.
double RigidTool::enter() {
  (void)go_to(state_.time, std::vector<double>(way_.size(), 0.0));
  return 0.0;
}

std::optional<Failed> RigidTool::leave(double, double& lost) {
  lost = 0.0;
  return std::nullopt;
}

std::optional<Failed> RigidTool::pass(const PassiveStep& step, PassiveReply& reply) {
  const std::size_t dim = way_.size();
  std::vector<double> mean(dim, 0.0);
  for (const std::vector<double>& impulse : step.impulses)
    for (std::size_t k = 0; k < impulse.size() && step.length() > 0.0; ++k)
      mean[k % dim] += impulse[k] / step.length();
  state_.time = step.begin;
  std::vector<double> from(dim, 0.0);
  if (step.length() > 0.0) {
    from = state_.place;
    if (std::optional<Failed> failed = go_to(step.end, mean)) return failed;
    state_.force = mean;
  }
  std::size_t pressed = 0;
  for (const std::vector<std::int32_t>& points : step.pressed) pressed += points.size() * dim;
  reply.compliance.assign(pressed * pressed, 0.0);
  reply.bulge = 0.0;
  reply.ports.resize(description_.ports.size());
  for (std::size_t p = 0; p < reply.ports.size(); ++p) {
    const std::size_t count = description_.ports[p].geometry.points.size();
    reply.ports[p].displacement.resize(count);
    reply.ports[p].velocity.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
      reply.ports[p].displacement[k] = state_.place[k % dim] - from[k % dim];
      reply.ports[p].velocity[k] = state_.velocity[k % dim];
    }
  }
  return std::nullopt;
}

/// A wall may have any number of points: what stays as it is, is not written again.
const PortValues& RigidTool::see(const Window& window, double time, bool) {
  if (shown_place_ != state_.place || shown_velocity_ != state_.velocity) {
    shown_place_ = state_.place;
    shown_velocity_ = state_.velocity;
    for (std::size_t k = 0; k < seen_.u.size(); ++k) {
      seen_.u[k] = state_.place[k % way_.size()];
      seen_.v[k] = state_.velocity[k % way_.size()];
    }
  }
  if (pushed_) std::ranges::fill(seen_.f, 0.0);
  pushed_ = false;
  std::size_t first = 0;
  for (std::size_t p = 0; p < description_.ports.size(); ++p) {
    for (const Waveform& imposed : window.request.boundary[p].forces) {
      if (imposed.empty()) continue;
      pushed_ = true;
      imposed_.resize(index(imposed.width));
      imposed.force_at(time, imposed_);
      for (std::size_t k = 0; k < imposed_.size(); ++k) {
        const std::size_t dim = way_.size();
        const std::size_t at =
            imposed.points.empty() ? k : index(imposed.points[k / dim]) * dim + k % dim;
        seen_.f[first + at] += imposed_[k];
      }
    }
    first += description_.ports[p].geometry.points.size();
  }
  return seen_;
}

/// What drives it works on its partners through it.
std::optional<Failed> RigidTool::record(BodyRecord& record) {
  record.energy = {};
  record.energy.external_work = state_.work;
  record.momentum.assign(way_.size(), 0.0);
  return std::nullopt;
}

void RigidTool::finish(std::size_t, PortResponse& reply) const {
  double square = 0.0;
  for (const double v : state_.velocity) square += v * v;
  reply.speed_bound = std::sqrt(square);
}

std::vector<double> RigidTool::measure() {
  std::vector<double> told = state_.place;
  told.insert(told.end(), state_.force.begin(), state_.force.end());
  return told;
}

Grid RigidTool::grid() { return grid_of(shape_->mesh()); }

std::vector<FieldValues> RigidTool::fields() {
  std::vector<double> u, v;
  for (int node = 0; node < shape_->mesh().node_count(); ++node) {
    u.insert(u.end(), state_.place.begin(), state_.place.end());
    v.insert(v.end(), state_.velocity.begin(), state_.velocity.end());
  }
  return {in_space(u, description_.dim), in_space(v, description_.dim)};
}

}  // namespace abut
