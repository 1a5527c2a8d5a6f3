// The passive form of a solid [M.128]: all mass on the nodes, and the way to and from its own
// scheme [M.130].

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "base/dense.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/rigid_motions.hpp"
#include "subdomain_solver/materials/crush_guard.hpp"
#include "subdomain_solver/solid_interior.hpp"
#include "subdomain_solver/solve/matrix_sum.hpp"
#include "subdomain_solver/time/massless_layer.hpp"
#include "subdomain_solver/time/motion_views.hpp"
#include "subdomain_solver/time/quasi_static.hpp"

namespace abut {

namespace {

/// Roundings of the energy of a strain of one, relative: below them a fall is no fall.
constexpr double energy_rounding = 2.0e-15;

/// Where velocities that have their angular momentum back have more energy than is allowed, and no
/// deformation to pay it with: as much of the way from plain ones to them as the energy lasts for.
/// Linear momentum is the same all along.
template <class Energy>
void stay_below(double most, const Vector& plain, std::vector<double>& v, const Energy& energy) {
  const double whole = energy();
  if (!(whole > most)) return;
  const Vector way = view(v) - plain;
  view(v) = plain;
  const double least = energy();
  view(v) += 0.5 * way;
  const double half = energy();
  // energy(s) = least + b s + c s^2
  const double c = 2.0 * (whole + least - 2.0 * half), b = whole - least - c;
  const double left = std::max(0.0, most - least), root = std::sqrt(b * b + 4.0 * c * left);
  const double part = b + root > 0.0 ? std::clamp(2.0 * left / (b + root), 0.0, 1.0) : 0.0;
  view(v) = plain + part * way;
}

/// Of a body's mass, what it has in passive steps of this length [s] of its statics [M.154]: it
/// resists a step by a tenth of what its lowest modes do, (2 share/pi)^2, so that bodies that
/// contact alone holds do not give way without bounds. What it bears goes in further steps at one
/// place.
double nearly_nothing(const FeModel& model, double step) {
  constexpr double share = 0.5;  // of a step, in which a wave crosses the body
  const Mesh& mesh = model.mesh();
  double square = 0.0;  // [m^2] of the diagonal
  for (int i = 0; i < mesh.dim; ++i) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t k = index(i); k < mesh.points.size(); k += index(mesh.dim)) {
      low = std::min(low, mesh.points[k]);
      high = std::max(high, mesh.points[k]);
    }
    square += (high - low) * (high - low);
  }
  const double wave = model.material().moduli().p_wave() / model.material().density();  // [m^2/s^2]
  return share * share * step * step * wave / square;
}

/// [J] by which a scheme tells the energy of a body lower than it is because loads of its own
/// accelerate it [M.163]: that of central differences is by velocities half a step apart. None of
/// rigid bodies, which have no midpoint step. `port_forces`: a load that is not the body's own.
double told_lower(const Problem& problem, const MidpointStep* midpoint,
                  const Integrator& integrator, const Load* port_forces, const Motion& motion,
                  double time) {
  if (midpoint == nullptr) return 0.0;
  const Vector& whole = midpoint->mass();
  Vector free = Vector::Zero(problem.model->dofs());  // [N], then [m/s^2]
  for (const auto& load : problem.loads)
    if (load.get() != port_forces) load->add(time, motion.q, free);
  for (const Prescribed& p : problem.supports) free(p.dof) = 0.0;
  free = (whole.array() > 0.0).select(free.cwiseQuotient(whole), 0.0);
  const Vector force = problem.model->lumped_mass().cwiseProduct(free);
  const double square = free.dot(force);
  if (!(square > 0.0)) return 0.0;
  Motion falls = motion;
  view(falls.v).setZero();
  view(falls.a) = std::clamp(view(motion.a).dot(force) / square, 0.0, 1.0) * free;
  return -integrator.kinetic(falls);
}

}  // namespace

void SolidInterior::find_passive() {
  const bool joined = std::ranges::any_of(joined_, [](char yes) { return yes != 0; });
  if (description_.quasi_static && (parts_.reduced != nullptr || joined || description_.dim == 1))
    return;
  // Its rows know of distances alone, not of what is wanted and still to come.
  if (parts_.pressed_over.value_or(0.0) > 0.0 && !description_.quasi_static) return;
  able_.passive = this;
  description_.can.passive = true;
  description_.can.only_passive = parts_.massive_surface && !description_.quasi_static;
}

/// What only passive bodies need is made when the first of them needs it.
void SolidInterior::start_passive() {
  if (midpoint_ || rigid_step_) return;
  std::vector<const Load*> loads;
  const bool own = parts_.reduced != nullptr || parts_.whole_loads.empty();
  for (const auto& load : own ? parts_.problem->loads : parts_.whole_loads)
    if (load.get() != port_forces_) loads.push_back(load.get());
  if (parts_.rigid != nullptr) {
    const Mesh& mesh = parts_.model->mesh();
    std::vector<Eigen::Vector3d> arms;
    for (const NamedNodes& port : ports_) {
      for (const std::int32_t node : port.nodes) {
        Eigen::Vector3d& arm = arms.emplace_back(-parts_.rigid->centre());
        for (int i = 0; i < mesh.dim; ++i) arm(i) += mesh.points[node * mesh.dim + i];
      }
    }
    rigid_step_ = std::make_unique<RigidStep>(*parts_.rigid, std::move(arms), std::move(loads));
    whole_mass_ = mass_;
    return;
  }
  const FeModel& nodes = *parts_.model;
  const bool reduced = parts_.reduced != nullptr, linear = parts_.problem->model->is_linear();
  whole_mass_ = reduced ? mass_ : diagonal_matrix(nodes.whole_mass());
  if (!reduced && !nodes.massless().empty()) given_mass_ = nodes.given_mass();
  Vector mass = reduced ? parts_.problem->model->lumped_mass() : nodes.whole_mass();
  if (description_.quasi_static) {
    mass *= nearly_nothing(nodes, parts_.scheme.step);
    whole_mass_ = diagonal_matrix(mass);
  }
  midpoint_ = std::make_unique<MidpointStep>(MidpointStep::Body{
      parts_.problem.get(), linear ? nullptr : parts_.model.get(), std::move(mass),
      std::move(loads), energy_rounding * nodes.material().moduli().p_wave() * nodes.volume(),
      description_.quasi_static});
}

/// [J] kinetic, in the passive form.
double SolidInterior::moving_energy() const {
  const Motion& motion = state_.motion;
  if (parts_.rigid != nullptr) return parts_.rigid->kinetic(motion.q, motion.v);
  return 0.5 * view(motion.v).dot(midpoint_->mass().cwiseProduct(view(motion.v)));
}

/// [J] kinetic, in the form that the body is in, of what supports move: v_h (M v)_h / 2.
/// Whatever mass a change of form brings there, it moves as they say, and that is their work.
double SolidInterior::held_energy() const {
  if (parts_.reduced) return 0.0;
  const auto v = view(state_.motion.v);
  const SparseMatrix& mass = mass_of_form();  // symmetric
  double energy = 0.0;
  for (const Prescribed& p : parts_.problem->supports)
    energy += 0.5 * v(p.dof) * mass.col(p.dof).dot(v);
  return energy;
}

/// Rigid motions of the body where it is, that no support holds, all or translations alone:
/// (coordinates, k).
Eigen::MatrixXd SolidInterior::free_motions(bool turns) {
  see_nodes();
  std::vector<double> at = parts_.model->mesh().points;
  for (std::size_t k = 0; k < at.size(); ++k) at[k] += u_[k];
  std::vector<int> held;
  for (const Prescribed& p : parts_.problem->supports) held.push_back(p.dof);
  Eigen::MatrixXd motions = rigid_motions(*parts_.model, at);
  if (!turns)  // they come first
    motions = motions.leftCols(std::min<Eigen::Index>(motions.cols(), description_.dim)).eval();
  return vanishing_on(held, motions);
}

/// [kg m/s] of the nodes, in their frames, as the scheme tells it.
Vector SolidInterior::nodal_momentum() {
  see_nodes();
  Vector momentum = momentum_;
  parts_.model->to_frames({momentum.data(), nodal_values()});
  return momentum;
}

/// Momentum is made what it was, and angular momentum as far as the energy lasts: what deforms pays
/// for it first, and gets what another mass on the nodes has lost.
template <class Energy>
void SolidInterior::keep_momenta(const Vector& momentum, double most, const Energy& energy) {
  if (!parts_.reduced) keep_momentum(free_motions(false), momentum);
  const Vector plain = view(state_.motion.v);
  if (!parts_.reduced) keep_momentum(free_motions(true), momentum);
  if (energy() < most) take_from_deformation(energy() - most);
  for (int k = 0; k < 3 && energy() > most; ++k) take_from_deformation(energy() - most);
  stay_below(most, plain, state_.motion.v, energy);
}

double SolidInterior::enter() {
  if (is_passive()) return 0.0;
  start_passive();
  Motion& motion = state_.motion;
  parts_.problem->contact = nullptr;
  if (description_.quasi_static) return come_to_rest();
  if (!state_.begun) {  // velocities of the start are those of all nodes
    motion.history.resize(parts_.problem->model->history_size(), 0.0);
    for (const Prescribed& p : parts_.problem->supports) motion.q[p.dof] = p.value(state_.time);
    parts_.problem->set_rates(state_.time, parts_.scheme.step, motion);
    ModelResponse response;
    if (parts_.problem->model->evaluate(motion.q, motion.history, Model::Want::force, response))
      motion.stored = response.stored;
    state_.begun = true;
    motion.a.clear();
    motion.force.assign(motion.v.size(), 0.0);
    return 0.0;
  }
  const double guard = store_guarded();
  const Vector momentum = parts_.reduced ? Vector() : nodal_momentum();
  double before = parts_.scheme.integrator->kinetic(motion);
  const double held = held_energy();
  const double lower = told_lower(*parts_.problem, midpoint_.get(), *parts_.scheme.integrator,
                                  port_forces_, motion, state_.time);
  spread_velocities();
  motion.a.clear();
  const double work = held_energy() - held + lower;
  motion.external_work += work;
  before += work;
  motion.force.assign(motion.v.size(), 0.0);
  std::ranges::fill(state_.port_force, 0.0);
  state_.light = {};
  if (surfaces_ != nullptr) surfaces_->let_go();
  // What crushed cells store anew comes from motion.
  keep_momenta(momentum, before - guard, [this] { return moving_energy(); });
  // Plain ones have too much themselves. Alpha schemes tell momentum ahead of velocities while
  // forces change [M.24]: what it asks beyond the energy before is given.
  if (!parts_.reduced && moving_energy() > before)
    stay_below(before, mean_motion(), motion.v, [this] { return moving_energy(); });
  return before - moving_energy() - guard;
}

/// Into the passive form of statics. Nothing of its energy changes.
double SolidInterior::come_to_rest() {
  Motion& motion = state_.motion;
  motion.history.resize(parts_.problem->model->history_size(), 0.0);
  motion.v.assign(motion.q.size(), 0.0);
  motion.force.resize(motion.q.size(), 0.0);
  motion.a.clear();
  state_.begun = true;
  std::ranges::fill(state_.port_force, 0.0);
  state_.light = {};
  if (surfaces_ != nullptr) surfaces_->let_go();
  return 0.0;
}

/// Out of it: where it is, under the forces of its cells, until its next step finds the others.
std::optional<Failed> SolidInterior::stand_still(double time) {
  Motion& motion = state_.motion;
  ModelResponse here;
  if (!parts_.problem->model->evaluate(motion.q, motion.history, Model::Want::force, here))
    return failed_newton({NewtonReport::End::inadmissible}, time);
  motion.a.assign(motion.q.size(), 0.0);
  store(here.force, motion.force);
  motion.stored = here.stored;
  if (port_forces_ != nullptr) port_forces_->impose({}, {});
  std::ranges::fill(state_.port_force, 0.0);
  state_.light = {};
  state_.time = time;
  if (port_map_) port_map_->displacement(motion.q, places_);
  return std::nullopt;
}

/// Takes the energy that is stored anew where cells are crushed already; by how much [J] it grows.
double SolidInterior::store_guarded() {
  Motion& motion = state_.motion;
  if (parts_.reduced != nullptr || parts_.problem->model->is_linear()) return 0.0;
  FeModel& cells = *parts_.model;
  if (!cells.guard(cells.least_volume(motion.q) < crushed)) return 0.0;
  ModelResponse response;
  const double before = motion.stored;
  if (cells.evaluate(motion.q, motion.history, Model::Want::force, response))
    motion.stored = response.stored;
  cells.guard(false);
  return motion.stored - before;
}

/// Velocities of the body's centre at all nodes where nothing holds it, else none; supports go on.
Vector SolidInterior::mean_motion() {
  see_nodes();
  const std::size_t dim = index(description_.dim);
  std::vector<double> mean(nodal_values(), 0.0), centre(dim, 0.0);
  for (std::size_t k = 0; k < mean.size(); ++k) centre[k % dim] += momentum_(k) / description_.mass;
  if (parts_.problem->supports.empty())
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] = centre[k % dim];
  parts_.model->to_frames(mean);
  for (const Prescribed& p : parts_.problem->supports) mean[p.dof] = state_.motion.v[p.dof];
  return view(mean);
}

/// To nodes of the layer, which take that of what had their mass.
void SolidInterior::spread_velocities() {
  if (given_mass_.size() == 0) return;
  std::vector<double>& v = state_.motion.v;
  const Vector momentum = given_mass_ * view(v), mass = given_mass_ * Vector::Ones(momentum.size());
  for (const int dof : parts_.model->massless()) v[dof] = momentum(dof) / mass(dof);
}

/// Impulses on nodes of the layer strike what has their mass, in the shares in which they have its
/// velocity: none is lost.
void SolidInterior::hand_on(Vector& impulse) {
  if (parts_.reduced != nullptr || parts_.model->massless().empty()) return;
  if (given_mass_.size() == 0) given_mass_ = parts_.model->given_mass();
  const Vector mass = given_mass_ * Vector::Ones(impulse.size());
  Vector speed = Vector::Zero(impulse.size());
  for (const int dof : parts_.model->massless())
    speed(dof) = std::exchange(impulse(dof), 0.0) / mass(dof);
  impulse += given_mass_.transpose() * speed;
}

/// From nodes of the layer, to what takes their mass: nothing that is held.
void SolidInterior::gather_velocities() {
  if (given_mass_.size() == 0) return;
  std::vector<double>& v = state_.motion.v;
  const Vector momentum = given_mass_.transpose() * view(v);
  const Vector taken = given_mass_.transpose() * Vector::Ones(momentum.size());
  for (Eigen::Index i = 0; i < taken.size(); ++i) {
    if (!(taken(i) > 0.0)) continue;
    const double own = midpoint_->mass()(i);
    v[i] = (own * v[i] + momentum(i)) / (own + taken(i));
  }
}

/// Rigid motions that no support holds make momentum and angular momentum what they were: mass
/// matrices that are not those of the nodes alone have other ones.
void SolidInterior::keep_momentum(const Eigen::MatrixXd& motions, const Vector& momentum) {
  if (motions.cols() == 0) return;
  const Eigen::MatrixXd heavy = motions.transpose() * (mass_of_form() * motions);
  const Vector missing = motions.transpose() * (momentum - nodal_momentum());
  view(state_.motion.v) += motions * solve_symmetric(heavy, missing);
}

std::optional<Failed> SolidInterior::leave(double time, double& lost) {
  lost = 0.0;
  if (!is_passive()) return std::nullopt;
  if (description_.quasi_static) return stand_still(time);
  const State before = state_;
  const Vector momentum = parts_.reduced ? Vector() : nodal_momentum();
  double present = moving_energy() + state_.motion.stored;
  double work = 0.0;
  if (std::optional<Failed> failed = restart(time, work)) {
    state_ = before;
    return failed;
  }
  work -= told_lower(*parts_.problem, midpoint_.get(), *parts_.scheme.integrator, port_forces_,
                     state_.motion, time);
  present += work;
  state_.motion.external_work += work;
  const auto total = [this] {
    return parts_.scheme.integrator->kinetic(state_.motion) + state_.motion.stored;
  };
  keep_momenta(momentum, present, total);
  if (auto failed = turned_otherwise(momentum, time)) {
    state_ = before;
    return failed;
  }
  lost = present - total();
  if (port_map_) port_map_->displacement(state_.motion.q, places_);
  return std::nullopt;
}

/// The body's own scheme begins, under its own loads. Returns what these and the supports do
/// meanwhile.
std::optional<Failed> SolidInterior::restart(double time, double& work) {
  Motion& motion = state_.motion;
  const std::vector<double> q = motion.q, v = motion.v;
  if (!parts_.reduced) gather_velocities();
  parts_.problem->contact = nullptr;
  if (port_forces_ != nullptr) port_forces_->impose({}, {});
  parts_.problem->set_rates(time, parts_.scheme.step, motion);
  // Where it was before the passive windows says little of where it is.
  if (MasslessLayer* layer = parts_.scheme.integrator->able().layer) layer->release();
  if (auto failed = parts_.scheme.integrator->begin(motion, time)) return failed;
  std::ranges::fill(state_.port_force, 0.0);
  state_.light = {};
  state_.time = time;
  if (parts_.reduced) return std::nullopt;
  for (const Prescribed& p : parts_.problem->supports)
    work -= 0.5 * midpoint_->mass()(p.dof) * v[p.dof] * v[p.dof];
  work += held_energy();
  if (parts_.model->massless().empty()) return std::nullopt;
  const Vector& loads = parts_.problem->external_force(time, motion.q);
  for (const int dof : parts_.model->massless()) work += loads(dof) * (motion.q[dof] - q[dof]);
  return std::nullopt;
}

void SolidInterior::take_impulses(const PassiveStep& step) {
  now_.assign(port_map_->values(), 0.0);
  for (std::size_t p = 0; p < step.impulses.size(); ++p)
    std::ranges::copy(step.impulses[p],
                      now_.begin() + static_cast<std::ptrdiff_t>(port_map_->first(p)));
}

/// What accelerates modes, whose mass is one, is left as their force: reactions are told by it.
std::optional<Failed> SolidInterior::step_modes(const PassiveStep& step) {
  Motion& motion = state_.motion;
  const std::vector<double> before = motion.v;
  if (auto failed = midpoint_->step(motion, step.begin, step.end, change_)) return failed;
  for (std::size_t k = 0; k < before.size(); ++k)
    motion.force[k] = (motion.v[k] - before[k]) / step.length();
  return std::nullopt;
}

/// Cells that are crushed, or would be by the step, are guarded in it.
std::optional<Failed> SolidInterior::step_guarded(const PassiveStep& step) {
  Motion& motion = state_.motion;
  FeModel& cells = *parts_.model;
  const auto take = [&] { return midpoint_->step(motion, step.begin, step.end, change_); };
  if (parts_.reduced != nullptr) return step_modes(step);
  if (parts_.problem->model->is_linear()) return take();
  if (cells.guard(cells.least_volume(motion.q) < nearly_crushed)) return take();
  const Motion before = motion;
  std::optional<Failed> failed = take();
  if ((!failed && cells.least_volume(motion.q) >= crushed) || !cells.guard(true)) return failed;
  motion = before;
  return take();
}

/// Nothing but the step sees guarded laws.
std::optional<Failed> SolidInterior::pass(const PassiveStep& step, PassiveReply& reply) {
  std::optional<Failed> failed = pass_guarded(step, reply);
  parts_.model->guard(false);
  return failed;
}

std::optional<Failed> SolidInterior::pass_guarded(const PassiveStep& step, PassiveReply& reply) {
  Motion& motion = state_.motion;
  take_impulses(step);
  reply.held = 0.0;
  if (step.length() == 0.0) {
    port_map_->displacement(motion.q, before_);
    reply.bulge = 0.0;
  } else if (rigid_step_) {
    if (auto failed = rigid_step_->step(motion, step.begin, step.end, now_)) return failed;
    before_ = rigid_step_->moved();
    reply.bulge = rigid_step_->bulge();
  } else {
    change_.setZero(parts_.problem->model->dofs());
    port_map_->lift(motion.q, now_, change_);
    if (description_.quasi_static) midpoint_->loosen(step.looser);
    midpoint_->go_on_from_last(step.again);
    if (auto failed = step_guarded(step)) return failed;
    if (QuasiStatic* statics = parts_.scheme.integrator->able().statics)
      reply.held =
          statics->tell_held(midpoint_->borne(), midpoint_->moved(), midpoint_->acting(), motion);
    port_map_->velocity(motion.q, midpoint_->moved(), before_);  // a linear map
    reply.bulge = 0.0;
  }
  state_.time = step.end;
  if (step.length() > 0.0) {  // one of none leaves those of the last
    state_.port_force = now_;
    for (double& force : state_.port_force) force /= step.length();
  }
  port_map_->displacement(motion.q, places_);
  port_map_->velocity(motion.q, motion.v, seen_.v);
  reply.ports.resize(ports_.size());
  std::vector<std::size_t> pressed;
  const std::size_t dim = index(description_.dim);
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    const std::size_t first = port_map_->first(p), count = port_map_->width(p);
    const auto from = static_cast<std::ptrdiff_t>(first);
    const auto until = static_cast<std::ptrdiff_t>(first + count);
    reply.ports[p].displacement.assign(before_.begin() + from, before_.begin() + until);
    reply.ports[p].velocity.assign(seen_.v.begin() + from, seen_.v.begin() + until);
    if (p >= step.pressed.size()) continue;
    for (const std::int32_t point : step.pressed[p])
      for (std::size_t i = 0; i < dim; ++i) pressed.push_back(first + index(point) * dim + i);
  }
  if (pressed.empty()) {
    reply.compliance.clear();
  } else if (rigid_step_) {
    rigid_step_->compliance(pressed, reply.compliance);
  } else if (pressed.size() > PassiveReply::most_whole && !joins_ && !description_.quasi_static) {
    midpoint_->bound(motion, *port_map_, pressed, reply.compliance);
  } else if (!midpoint_->compliance(motion, *port_map_, pressed, reply.compliance)) {
    return failed_newton({NewtonReport::End::singular}, step.end);
  }
  return std::nullopt;
}

}  // namespace abut
