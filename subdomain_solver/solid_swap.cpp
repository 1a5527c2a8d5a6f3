// How a solid goes on where another model or another mesh of it has left it.

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/dense.hpp"
#include "base/error.hpp"
#include "subdomain_solver/fe/field_transfer.hpp"
#include "subdomain_solver/fe/largest_rotation.hpp"
#include "subdomain_solver/fe/rigid_motions.hpp"
#include "subdomain_solver/rigid/rigid_fit.hpp"
#include "subdomain_solver/solid_interior.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {
namespace {

/// [rad] by which a rigid body may have turned where a law of small rotations takes over: that
/// lengthens it by 1e-4 of itself.
constexpr double small_turn = 0.0141;
/// Of the energy before, that a swap may add to what is stored: more is no rounding of a mesh.
constexpr double most_strain = 0.01;

const char* another_law =
    "Give a law of finite strain such as neo_hookean, or keep the body as it was";

/// Momentum and angular momentum (numbers, fields) of momenta of the nodes, along the axes of
/// space, where these are displaced by u; of an axisymmetric body that along its axis alone.
Eigen::MatrixXd momenta_of(const FeModel& model, std::span<const double> u,
                           const Eigen::MatrixXd& nodal) {
  const Eigen::Index dim = model.mesh().dim;
  Eigen::MatrixXd out;
  std::vector<double> angular;
  for (Eigen::Index k = 0; k < nodal.cols(); ++k) {
    const Vector momentum = nodal.col(k);
    angular_momentum(model.mesh(), u, momentum, angular);
    if (k == 0) out.setZero(dim + static_cast<Eigen::Index>(angular.size()), nodal.cols());
    for (Eigen::Index i = 0; i < momentum.size(); ++i) out(i % dim, k) += momentum(i);
    for (std::size_t i = 0; i < angular.size(); ++i)
      out(dim + static_cast<Eigen::Index>(i), k) = angular[i];
  }
  if (model.round()) return out.middleRows(1, 1);
  return out;
}

/// Columns of velocities (nodal values, k), in the nodes' frames, as momenta along the axes of
/// space.
Eigen::MatrixXd momenta_in_space(const FeModel& model, const SparseMatrix& mass,
                                 const Eigen::MatrixXd& velocities) {
  Eigen::MatrixXd out = mass * velocities;
  for (Eigen::Index k = 0; k < out.cols(); ++k)
    model.to_space({out.col(k).data(), index(out.rows())});
  return out;
}

}  // namespace

/// Velocities and displacements are those of the other one, nearest in the mean square over the
/// mass; what follows from them is found when the first window begins (settle_swap).
void SolidInterior::take_from(const HandOver& handed) {
  const std::string of = fmt::format("body '{}'", description_.name);
  if (description_.quasi_static)
    throw RunError("moves, and a stage without inertia cannot go on from there", of,
                   "Give an integrator of motion");
  FeModel& model = *parts_.model;
  FieldTransfer transfer(handed.grid, model.mesh(), model.round());
  std::vector<double> u = transfer.to_nodes(handed.displacement);
  std::vector<double> v = transfer.to_nodes(handed.velocity);
  const bool small = parts_.problem->model->is_linear() && parts_.deforms && !handed.deforms;
  if (const double turn = small ? largest_rotation(model.mesh(), u) : 0.0; turn > small_turn)
    throw RunError(
        fmt::format("has turned by {:.3g} rad as a rigid one: its law takes that for strain", turn),
        of, another_law);
  State next;
  next.time = handed.record.time;
  if (port_map_) next.port_force.assign(port_map_->values(), 0.0);
  Motion& motion = next.motion;
  motion.dissipated = handed.record.energy.dissipated;
  motion.external_work = handed.record.energy.external_work;
  if (parts_.rigid != nullptr) {
    const Pose pose = fit_pose(*parts_.rigid, model, u).pose;
    motion.q = parts_.rigid->coordinates(pose);
    motion.v = parts_.rigid->rates(pose, fit_twist(*parts_.rigid, model, mass_, pose, v).twist);
  } else {
    model.to_frames(u);
    model.to_frames(v);
    motion.q = amplitudes_of(std::move(u));
    motion.v = amplitudes_of(std::move(v));
    for (const Prescribed& p : parts_.problem->supports) motion.q[p.dof] = p.value(next.time);
  }
  state_ = std::move(next);
  swapped_ = handed.record;
}

/// Coordinates of a field of the nodes, of models in which nodes move linearly.
std::vector<double> SolidInterior::amplitudes_of(std::vector<double> nodes) const {
  if (parts_.reduced == nullptr) return nodes;
  const Vector momentum = mass_ * view(nodes);
  Vector amplitudes = Vector::Zero(parts_.problem->model->dofs());
  parts_.map->lift({}, span_of(momentum), amplitudes);  // Phi^T M u: modes have a mass of one
  store(amplitudes, nodes);
  return nodes;
}

/// The smallest rigid velocity that gives the body the momentum and angular momentum that it had,
/// along what no support holds [M.156].
void SolidInterior::keep_momenta(const BodyRecord& before) {
  std::vector<double> all = before.momentum;
  all.insert(all.end(), before.angular_momentum.begin(), before.angular_momentum.end());
  Eigen::VectorXd wanted = view(all);
  if (parts_.model->round()) wanted = wanted.segment(1, 1).eval();
  see_nodes();
  const FeModel& model = *parts_.model;
  if (parts_.reduced == nullptr) {
    std::vector<double> at = model.mesh().points;
    for (std::size_t k = 0; k < at.size(); ++k) at[k] += u_[k];
    const Eigen::MatrixXd rigid = rigid_motions(model, at);
    const Eigen::MatrixXd of = momenta_of(model, u_, momenta_in_space(model, mass_, rigid));
    // Any momentum of the nodes of these sums asks the same of rigid motions.
    return keep_momentum(free_motions(true), mass_ * (rigid * least_squares(of, wanted)));
  }
  // Of modes those without frequency, which come first; of a rigid body all that it has.
  const auto count = static_cast<Eigen::Index>(state_.motion.v.size());
  const auto rigid =
      parts_.rigid != nullptr ? count : std::ranges::count(parts_.frequencies, 0.0);
  if (!parts_.constraints.empty() || rigid < wanted.size()) return;
  const Eigen::MatrixXd rates = Eigen::MatrixXd::Identity(count, rigid);
  Eigen::MatrixXd fields(static_cast<Eigen::Index>(nodal_values()), rigid);
  for (Eigen::Index k = 0; k < rigid; ++k) {
    const Vector rate = rates.col(k);
    parts_.map->velocity(state_.motion.q, span_of(rate), {fields.col(k).data(), nodal_values()});
  }
  const Eigen::VectorXd missing = wanted - momenta_of(model, u_, momentum_);
  view(state_.motion.v) +=
      rates *
      least_squares(momenta_of(model, u_, momenta_in_space(model, mass_, fields)), missing);
}

/// Accelerations and forces of the begin are there: momenta become what they were, and what the
/// other model had of energy and this one has not is accounted for as dissipated; what is added is
/// work from outside.
std::optional<Failed> SolidInterior::settle_swap() {
  const BodyRecord before = *std::exchange(swapped_, std::nullopt);
  for (int k = 0; k < 2; ++k) keep_momenta(before);  // once more, for the rounding
  see_nodes();
  const Energy now = energy();
  const double given_up = before.energy.total() - now.total();
  (given_up > 0.0 ? state_.motion.dissipated : state_.motion.external_work) += std::abs(given_up);
  const double strained = now.stored - before.energy.stored;
  if (strained <= most_strain * before.energy.total()) return std::nullopt;
  return Failed{Failed::Cause::non_finite, state_.time,
                fmt::format("body '{}' would store {:.3g} J more than the model that it takes over "
                            "from, which had {:.3g} J in all: its mesh or law sees strain where "
                            "that one had none; give it another mesh, or a law of finite strain",
                            description_.name, strained, before.energy.total())};
}

}  // namespace abut
