#include "subdomain_solver/rigid/rigid_tool.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/index.hpp"
#include "subdomain_solver/fe/surface_shape.hpp"
#include "subdomain_solver/port_geometry.hpp"
#include "subdomain_solver/solid_fields.hpp"

namespace abut {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// [rad] in one step, in which points go straight: arcs leave their chords by 1.3e-3 of the arm.
constexpr double most_tool_turn = 0.1;

/// Arms of places [m] (n, dim), appended.
void add_arms(const std::vector<double>& points, std::size_t dim, const Vector3d& about,
              std::vector<Vector3d>& arms) {
  for (std::size_t k = 0; k < points.size(); k += dim) {
    Vector3d arm = -about;
    for (std::size_t i = 0; i < dim; ++i) arm(static_cast<Eigen::Index>(i)) += points[k + i];
    arms.push_back(arm);
  }
}

/// Adds what a matrix does to the arms to values (n, dim) of their points.
void add_turn(const Matrix3d& matrix, std::span<const Vector3d> arms, std::size_t dim,
              std::span<double> values) {
  for (std::size_t p = 0; p < arms.size(); ++p) {
    const Vector3d way = matrix * arms[p];
    for (std::size_t i = 0; i < dim; ++i) values[p * dim + i] += way(static_cast<Eigen::Index>(i));
  }
}

}  // namespace

RigidTool::RigidTool(std::string name, std::unique_ptr<FeModel> shape, std::vector<Way> way,
                     std::optional<ToolTurn> turn, double step,
                     const std::vector<SolidInterior::PortNodes>& ports, const std::string& words)
    : shape_(std::move(shape)), way_(std::move(way)), turn_(std::move(turn)) {
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
    first_.push_back(values / index(mesh.dim));
    values += port.geometry.points.size();
    if (turn_) add_arms(port.geometry.points, index(mesh.dim), turn_->about(), arms_);
    description_.ports.push_back(std::move(port));
  }
  for (const Vector3d& arm : arms_) farthest_ = std::max(farthest_, arm.norm());
  constexpr const char* axes = "xyz";
  for (int i = 0; i < mesh.dim; ++i)
    description_.measures.push_back(fmt::format("displacement.{}", axes[i]));
  for (int i = 0; i < mesh.dim; ++i)
    description_.measures.push_back(fmt::format("force.{}", axes[i]));
  if (turn_) description_.measures.insert(description_.measures.end(), {"angle", "moment"});
  description_.fields = {{"displacement", FieldPlace::nodes, 3},
                         {"velocity", FieldPlace::nodes, 3}};
  seen_.u.assign(values, 0.0);
  seen_.v = seen_.a = seen_.f = seen_.u;
  const std::vector<double> zero(way_.size(), 0.0);
  state_.place = state_.force = state_.velocity = zero;
}

void RigidTool::state(Archive& archive) {
  archive.field("time", state_.time);
  archive.field("place", state_.place);
  archive.field("force", state_.force);
  archive.field("work", state_.work);
  archive.field("velocity", state_.velocity);
  if (!turn_) return;
  archive.field("angle", state_.angle);
  archive.field("before", state_.before);
  archive.field("length", state_.length);
  archive.field("moment", state_.moment);
}

std::optional<Failed> RigidTool::begin(const Window& window) {
  return move_to(window, window.request.window.begin);
}

std::optional<Failed> RigidTool::step(const Window& window, int i, bool) {
  return move_to(window, window.grid.time(i));
}

/// Adds a force on a value of the ports.
void RigidTool::add(double force, std::size_t value, Load& to) const {
  const std::size_t dim = way_.size(), i = value % dim;
  to.force[i] += force;
  if (turn_) to.on_arms.row(static_cast<Eigen::Index>(i)) += force * arms_[value / dim].transpose();
}

/// [N] mean of the partners' forces since the last step.
void RigidTool::mean_force(const Window& window, double time, Load& mean) {
  mean = no_load();
  const std::size_t dim = way_.size();
  const double length = time - state_.time;
  if (length <= 0.0) return;
  for (std::size_t p = 0; p < first_.size(); ++p) {
    for (const Waveform& imposed : window.request.boundary[p].forces) {
      if (imposed.empty()) continue;
      imposed_.resize(index(imposed.width));
      imposed.impulse(state_.time, time, imposed_);
      for (std::size_t k = 0; k < imposed_.size(); ++k) {
        const std::size_t point = imposed.points.empty() ? k / dim : index(imposed.points[k / dim]);
        add(imposed_[k] / length, (first_[p] + point) * dim + k % dim, mean);
      }
    }
  }
}

/// Between its steps the tool moves evenly, as its trace tells, so that partners' forces do the
/// work of their impulse, whatever they do meanwhile.
std::optional<Failed> RigidTool::move_to(const Window& window, double time) {
  see(window, time, true);  // for the forces
  Load force = no_load(), mean;
  for (std::size_t k = 0; pushed_ && k < seen_.f.size(); ++k) add(seen_.f[k], k, force);
  mean_force(window, time, mean);
  if (std::optional<Failed> failed = go_to(time, mean)) return failed;
  state_.force = force.force;
  if (turn_) state_.moment = moment(force);
  return std::nullopt;
}

/// Against a mean force on the way.
std::optional<Failed> RigidTool::go_to(double time, const Load& mean) {
  const double length = time - state_.time;
  if (turn_)
    if (std::optional<Failed> failed = turn_to(time, mean)) return failed;
  for (std::size_t i = 0; i < way_.size(); ++i) {
    const double place = way_[i](time);
    if (!std::isfinite(place)) {
      return Failed{Failed::Cause::non_finite, time,
                    fmt::format("model.rigid_tool.way[{}] has no value at {:g} s: give an "
                                "expression with one at all times of the run",
                                i, time)};
    }
    const double moved = place - state_.place[i];
    state_.work -= mean.force[i] * moved;
    if (length > 0.0) state_.velocity[i] = moved / length;
    state_.place[i] = place;
  }
  state_.time = time;
  return std::nullopt;
}

std::optional<Failed> RigidTool::turn_to(double time, const Load& mean) {
  const double length = time - state_.time, angle = turn_->angle(time);
  if (!std::isfinite(angle)) {
    return Failed{Failed::Cause::non_finite, time,
                  fmt::format("model.rigid_tool.turn.angle has no value at {:g} s: give an "
                              "expression with one at all times of the run",
                              time)};
  }
  const double turn = std::abs(angle - state_.angle);
  if (length > 0.0 && turn > most_tool_turn) {
    return Failed{Failed::Cause::step_too_small, time,
                  fmt::format("the tool turns by {:.3g} rad in a step of {:.3g} s, in which its "
                              "points go straight, and {:g} rad are the most: give "
                              "model.rigid_tool.step at most {:.2g} s",
                              turn, length, most_tool_turn, 0.5 * length * most_tool_turn / turn)};
  }
  if (length > 0.0) {
    state_.before = state_.angle;
    state_.length = length;
  } else if (angle != state_.angle) {
    state_.before = angle;
  }
  state_.angle = angle;
  if (length > 0.0)
    state_.work -= mean.on_arms.cwiseProduct(turn_->between(state_.before, angle)).sum();
  return std::nullopt;
}

/// [1/s] times an arm: how fast its point went round over the last step, straight.
Matrix3d RigidTool::turning() const {
  if (state_.length <= 0.0) return Matrix3d::Zero();
  return turn_->between(state_.before, state_.angle) / state_.length;
}

/// [N m] about the axis: of forces f on turned arms R r, that of the moments R r x f.
double RigidTool::moment(const Load& load) const {
  const Matrix3d sum = load.on_arms * (Matrix3d::Identity() + turned()).transpose();  // f (R r)^T
  const Vector3d moment(sum(2, 1) - sum(1, 2), sum(0, 2) - sum(2, 0), sum(1, 0) - sum(0, 1));
  return turn_->axis().dot(moment);
}

/// A tool that has not begun yet goes to where its way begins; one that cannot tells so in a step.
double RigidTool::enter() {
  (void)go_to(state_.time, no_load());
  return 0.0;
}

std::optional<Failed> RigidTool::leave(double, double& lost) {
  lost = 0.0;
  return std::nullopt;
}

std::optional<Failed> RigidTool::pass(const PassiveStep& step, PassiveReply& reply) {
  const std::size_t dim = way_.size();
  Load mean = no_load();
  for (std::size_t p = 0; p < step.impulses.size() && step.length() > 0.0; ++p)
    for (std::size_t k = 0; k < step.impulses[p].size(); ++k)
      add(step.impulses[p][k] / step.length(), first_[p] * dim + k, mean);
  state_.time = step.begin;
  std::vector<double> from(dim, 0.0);
  if (step.length() > 0.0) {
    from = state_.place;
    if (std::optional<Failed> failed = go_to(step.end, mean)) return failed;
    state_.force = mean.force;
    if (turn_) state_.moment = moment(mean);
  }
  std::size_t pressed = 0;
  for (const std::vector<std::int32_t>& points : step.pressed) pressed += points.size() * dim;
  reply.compliance.assign(pressed * pressed, 0.0);
  reply.bulge = reply.held = 0.0;
  reply.ports.resize(description_.ports.size());
  for (std::size_t p = 0; p < reply.ports.size(); ++p) {
    const std::size_t count = description_.ports[p].geometry.points.size();
    std::vector<double>&displacement = reply.ports[p].displacement,
    &velocity = reply.ports[p].velocity;
    displacement.resize(count);
    velocity.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
      displacement[k] = state_.place[k % dim] - from[k % dim];
      velocity[k] = state_.velocity[k % dim];
    }
    if (!turn_) continue;
    const std::span<const Vector3d> arms = std::span(arms_).subspan(first_[p], count / dim);
    const bool moves = step.length() > 0.0;
    add_turn(moves ? turn_->between(state_.before, state_.angle) : turned(), arms, dim,
             displacement);
    add_turn(turning(), arms, dim, velocity);
    const double turn = moves ? state_.angle - state_.before : 0.0;
    reply.bulge = 0.125 * turn * turn * farthest_;
  }
  return std::nullopt;
}

/// A wall may have any number of points: what stays as it is, is not written again.
const PortValues& RigidTool::see(const Window& window, double time, bool) {
  const std::size_t dim = way_.size();
  const std::array<double, 3> turn{state_.angle, state_.before, state_.length};
  if (shown_place_ != state_.place || shown_velocity_ != state_.velocity || shown_turn_ != turn) {
    shown_place_ = state_.place;
    shown_velocity_ = state_.velocity;
    shown_turn_ = turn;
    for (std::size_t k = 0; k < seen_.u.size(); ++k) {
      seen_.u[k] = state_.place[k % dim];
      seen_.v[k] = state_.velocity[k % dim];
    }
    if (turn_) {
      add_turn(turned(), arms_, dim, seen_.u);
      add_turn(turning(), arms_, dim, seen_.v);
    }
  }
  if (pushed_) std::ranges::fill(seen_.f, 0.0);
  pushed_ = false;
  for (std::size_t p = 0; p < description_.ports.size(); ++p) {
    for (const Waveform& imposed : window.request.boundary[p].forces) {
      if (imposed.empty()) continue;
      pushed_ = true;
      imposed_.resize(index(imposed.width));
      imposed.force_at(time, imposed_);
      for (std::size_t k = 0; k < imposed_.size(); ++k) {
        const std::size_t at =
            imposed.points.empty() ? k : index(imposed.points[k / dim]) * dim + k % dim;
        seen_.f[first_[p] * dim + at] += imposed_[k];
      }
    }
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

/// [m/s] of the points of a port over the last step.
double RigidTool::fastest(std::size_t port) const {
  double square = 0.0;
  if (!turn_) {
    for (const double v : state_.velocity) square += v * v;
    return std::sqrt(square);
  }
  Vector3d along = Vector3d::Zero();
  for (std::size_t i = 0; i < way_.size(); ++i)
    along(static_cast<Eigen::Index>(i)) = state_.velocity[i];
  const Matrix3d rate = turning();
  const std::size_t count = description_.ports[port].geometry.points.size() / way_.size();
  for (const Vector3d& arm : std::span(arms_).subspan(first_[port], count))
    square = std::max(square, (along + rate * arm).squaredNorm());
  return std::sqrt(square);
}

void RigidTool::finish(std::size_t port, PortResponse& reply) const {
  reply.speed_bound = fastest(port);
}

std::vector<double> RigidTool::measure() {
  std::vector<double> told = state_.place;
  told.insert(told.end(), state_.force.begin(), state_.force.end());
  if (turn_) told.insert(told.end(), {state_.angle, state_.moment});
  return told;
}

/// Cells that stand for a facet each are shown as facets.
Grid RigidTool::grid() {
  Grid grid = grid_of(shape_->mesh());
  if (!is_surface_shape(shape_->mesh())) return grid;
  constexpr std::int32_t line = 3, triangle = 5;  // of VTK
  const std::size_t each = way_.size() + 1;       // nodes of a cell, the last one inside
  std::vector<std::int32_t> nodes;
  for (std::size_t k = 0; k < grid.connectivity.size(); ++k)
    if ((k + 1) % each != 0) nodes.push_back(grid.connectivity[k]);
  grid.connectivity = std::move(nodes);
  for (std::size_t c = 0; c < grid.offsets.size(); ++c)
    grid.offsets[c] = static_cast<std::int32_t>(c * way_.size());
  std::ranges::fill(grid.types, way_.size() == 2 ? line : triangle);
  return grid;
}

std::vector<FieldValues> RigidTool::fields() {
  std::vector<double> u, v;
  for (int node = 0; node < shape_->mesh().node_count(); ++node) {
    u.insert(u.end(), state_.place.begin(), state_.place.end());
    v.insert(v.end(), state_.velocity.begin(), state_.velocity.end());
  }
  if (turn_) {
    std::vector<Vector3d> arms;
    add_arms(shape_->mesh().points, way_.size(), turn_->about(), arms);
    add_turn(turned(), arms, way_.size(), u);
    add_turn(turning(), arms, way_.size(), v);
  }
  return {in_space(u, description_.dim), in_space(v, description_.dim)};
}

}  // namespace abut
