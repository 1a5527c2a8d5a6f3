#include "subdomain_solver/modal/modal_reactions.hpp"

#include <utility>

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/rigid_motions.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

namespace {

/// The supports, and as many more coordinates as they leave rigid motions: what is in balance does
/// not pull at these.
FreeCoordinates holding(const FeModel& mesh, std::vector<int> supports) {
  const Eigen::MatrixXd loose = vanishing_on(supports, rigid_motions(mesh));
  const std::vector<int> more = determining_rows(loose, loose.cols());
  supports.insert(supports.end(), more.begin(), more.end());
  std::vector<Prescribed> all;
  for (const int dof : supports) all.push_back({dof, {}});
  return {mesh.dofs(), all};
}

}  // namespace

ModalReactions::ModalReactions(Body body, const std::vector<int>& supports,
                               const std::vector<HeldCoordinates>& constraints,
                               const std::string& where)
    : body_(std::move(body)),
      supports_(supports),
      held_(holding(body_.mesh, supports)),
      solver_(make_direct_solver()) {
  const std::vector<double> zero(index(body_.mesh.dofs()), 0.0);
  ModelResponse rest;
  const bool admissible = body_.mesh.evaluate(zero, {}, Model::Want::tangent, rest);
  ABUT_ASSERT(admissible);
  stiffness_ = std::move(rest.tangent);
  SparseMatrix inner;
  held_.extract(stiffness_, inner);
  if (held_.count() > 0 && !solver_->factor(inner)) {
    throw InputError(
        "has reactions without an answer: its stiffness is singular beyond rigid motions", where,
        "Join the parts of the mesh, or hold each of them.");
  }
  const int dim = body_.mesh.mesh().dim;
  shapes_.resize(body_.mesh.dofs(), static_cast<Eigen::Index>(constraints.size()) * dim);
  Eigen::Index column = 0;
  for (const HeldCoordinates& constraint : constraints) {
    for (int i = 0; i < dim; ++i, ++column) {
      Vector unit = Vector::Zero(body_.mesh.dofs());
      for (const int dof : constraint.dofs) unit(dof) = direction_of(body_.mesh, dof)(i);
      shapes_.col(column) = unit - at_rest(stiffness_ * unit);
    }
  }
}

/// Displacements of the mesh under forces, supports at rest [m] (dofs).
Vector ModalReactions::at_rest(const Vector& force) const {
  Vector u = Vector::Zero(force.size());
  if (held_.count() == 0) return u;
  Vector on_free, free;
  held_.pick(force, on_free);
  const bool solved = solver_->solve(on_free, free);
  ABUT_ASSERT(solved);  // it has been factored
  held_.add(free, u);
  return u;
}

/// What the stiffness carries to the supports: loads less inertia [N] (dofs).
const Vector& ModalReactions::carried(const Motion& motion, double time, const Vector& on_ports) {
  force_ = on_ports;
  for (const std::unique_ptr<Load>& load : body_.loads) load->add(time, {}, force_);
  external_.setZero(static_cast<Eigen::Index>(motion.q.size()));
  body_.map.lift(motion.q, span_of(force_), external_);
  if (motion.a.empty()) {
    rates_ = view(motion.force);  // in the passive form, means over the last step
  } else {
    body_.integrator.acceleration(motion, time, body_.step, external_, rates_);
  }
  acceleration_.resize(index(force_.size()));
  body_.map.acceleration(motion.q, motion.v, span_of(rates_), acceleration_);
  force_.noalias() -= body_.mass * view(acceleration_);
  return force_;
}

void ModalReactions::forces(const Motion& motion, double time, const Vector& on_ports,
                            Vector& out) {
  const Vector& force = carried(motion, time, on_ports);
  const Vector whole = stiffness_ * at_rest(force) - force;
  out.setZero(force.size());
  for (const int dof : supports_) out(dof) = whole(dof);
}

/// By Betti's theorem: no solve, for records in every window.
void ModalReactions::sums(const Motion& motion, double time, const Vector& on_ports,
                          std::vector<double>& out) {
  sums_.noalias() = shapes_.transpose() * carried(motion, time, on_ports);
  sums_ = -sums_;
  store(sums_, out);
}

}  // namespace abut
