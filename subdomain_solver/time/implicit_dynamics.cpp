#include "subdomain_solver/time/implicit_dynamics.hpp"

#include <cmath>
#include <limits>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

/// Balance of momentum at the end of a step, with the free accelerations as unknowns.
class ImplicitDynamics::Balance final : public Equations {
 public:
  Balance(ImplicitDynamics& owner, const Motion& motion, double time, double dt)
      : o_(owner), w_(owner.options_.weights), motion_(motion), end_(time + dt), dt_(dt) {
    const auto q = view(motion.q), v = view(motion.v), a = view(motion.a);
    q_start_ = q + dt * v + (0.5 - w_.beta) * dt * dt * a;  // for no acceleration at the end
    v_start_ = v + (1.0 - w_.gamma) * dt * a;
    a_ = a;
    for (const Prescribed& p : o_.problem_.supports)
      a_(p.dof) = (p.value(end_) - q_start_(p.dof)) / (w_.beta * dt * dt);
    past_ = w_.alpha_m * o_.times_mass(a);
    if (!w_.is_newmark()) {
      external_start_ = o_.problem_.external_force(time, motion.q);
      past_ += w_.alpha_f * (view(motion.force) - external_start_);
    }
  }

  Vector first_guess() const { return o_.free_.pick(a_); }

  [[nodiscard]] bool residual(const Vector& x, Vector& r, double& scale) override {
    for (int i = 0; i < o_.free_.count(); ++i) a_(o_.free_.list()[index(i)]) = x(i);
    q_ = q_start_ + w_.beta * dt_ * dt_ * a_;
    Model& model = *o_.problem_.model;
    const std::span<const double> q = span_of(q_);
    if (!model.evaluate(q, motion_.history, Model::Want::force, response)) return false;
    external_ = o_.problem_.external_force(end_, q);
    const Vector inertia = (1.0 - w_.alpha_m) * o_.times_mass(a_);
    const Vector inner = (1.0 - w_.alpha_f) * response.force;
    const Vector outer = (1.0 - w_.alpha_f) * external_;
    r = o_.free_.pick(inertia + inner - outer + past_);
    scale = std::max({inertia.norm(), inner.norm(), outer.norm(), past_.norm(),
                      model.roundoff(q) / o_.options_.newton.tolerance});
    return true;
  }

  [[nodiscard]] bool correct(const Vector& r, Vector& dx) override {
    Model& model = *o_.problem_.model;
    if (!model.is_linear() || o_.factored_dt_ != dt_) {
      ModelResponse here;
      const std::span<const double> q = span_of(q_);
      if (!model.evaluate(q, motion_.history, Model::Want::tangent, here)) return false;
      for (const std::unique_ptr<Load>& load : o_.problem_.loads)
        load->add_tangent(end_, q, here.tangent);
      const SparseMatrix whole =
          (1.0 - w_.alpha_m) * o_.mass_ + (1.0 - w_.alpha_f) * w_.beta * dt_ * dt_ * here.tangent;
      o_.free_.extract(whole, o_.matrix_);
      o_.factored_dt_ = 0.0;
      if (!o_.solver_->factor(o_.matrix_)) return false;
      o_.factored_dt_ = dt_;
    }
    if (!o_.solver_->solve(r, dx)) return false;
    dx = -dx;
    return true;
  }

  double smallest_step(const Vector& x) const override {
    return 4.0 * std::numeric_limits<double>::epsilon() * x.lpNorm<Eigen::Infinity>();
  }

  void finish(Motion& motion) const {
    const Vector v = v_start_ + w_.gamma * dt_ * a_;
    motion.external_work += external_work();
    motion.dissipated += response.dissipation;
    motion.stored = response.stored;
    motion.history = response.history;
    store(q_, motion.q);
    store(v, motion.v);
    store(a_, motion.a);
    store(response.force, motion.force);
  }

  ModelResponse response;

 private:
  /// [J] of the step, by loads and supports: what inertia and internal force take. With other
  /// weights than Newmark's these take damping too, and accelerations lag by (alpha_f - alpha_m)
  /// dt, so free coordinates are worked on by the loads, and supports see the lag made good.
  double external_work() const {
    const Vector moved = q_ - view(motion_.q);
    const Vector a = view(motion_.a);
    if (w_.is_newmark()) {
      const Vector now = response.force + o_.times_mass(a_);
      const Vector before = view(motion_.force) + o_.times_mass(a);
      return 0.5 * (now + before).dot(moved);
    }
    const double late = 0.5 - w_.alpha_m + w_.alpha_f;
    Vector mean =
        0.5 * (response.force + view(motion_.force)) + o_.times_mass(late * a_ + (1.0 - late) * a);
    for (int i : o_.free_.list()) mean(i) = 0.5 * (external_(i) + external_start_(i));
    return mean.dot(moved);
  }

  ImplicitDynamics& o_;
  const AlphaWeights& w_;
  const Motion& motion_;
  double end_, dt_;
  Vector q_start_, v_start_, a_, q_, past_, external_, external_start_;
};

ImplicitDynamics::ImplicitDynamics(const Problem& problem, const Options& options,
                                   std::unique_ptr<LinearSolver> solver)
    : problem_(problem),
      options_(options),
      solver_(std::move(solver)),
      free_(problem.model->dofs(), problem.supports) {
  mass_ = mass_matrix(*problem.model, options.mass);
}

Vector ImplicitDynamics::times_mass(const Vector& x) const { return mass_ * x; }

/// Adds the solution of M a = f on the free coordinates.
bool ImplicitDynamics::solve_mass(const Vector& force, Vector& acceleration) const {
  if (!mass_solver_) {
    SparseMatrix free_mass;
    FreeCoordinates(problem_.model->dofs(), problem_.supports).extract(mass_, free_mass);
    mass_solver_ = make_direct_solver();
    if (!mass_solver_->factor(free_mass)) return false;
  }
  Vector a;
  if (!mass_solver_->solve(free_.pick(force), a)) return false;
  free_.add(a, acceleration);
  return true;
}

void ImplicitDynamics::jump(Motion& motion, const Vector& change) {
  Vector a = view(motion.a);
  const bool solved = solve_mass(change, a);
  ABUT_ASSERT(solved);  // as at the begin
  store(a, motion.a);
}

/// Newmark's are those of the balance at every step's end. With other weights they lag: the balance
/// is solved for them.
Vector ImplicitDynamics::acceleration(const Motion& motion, double time, double step) const {
  if (options_.weights.is_newmark()) return view(motion.a);
  Vector a = Vector::Zero(static_cast<Eigen::Index>(motion.q.size()));
  problem_.set_accelerations(time, step, a);
  const Vector rest = problem_.external_force(time, motion.q) - view(motion.force) - times_mass(a);
  const bool solved = solve_mass(rest, a);
  ABUT_ASSERT(solved);  // as at the begin
  return a;
}

/// Accelerations from the balance at the begin: M a = f - r on the free coordinates. Those of
/// prescribed ones are the motion's own; none are given: zero.
std::optional<Failed> ImplicitDynamics::begin(Motion& motion, double time) {
  Model& model = *problem_.model;
  ModelResponse response;
  motion.history.resize(model.history_size(), 0.0);
  motion.a.resize(motion.q.size(), 0.0);
  Vector a = Vector::Zero(model.dofs());
  for (const Prescribed& p : problem_.supports) {
    motion.q[index(p.dof)] = p.value(time);
    a(p.dof) = motion.a[index(p.dof)];
  }
  if (!model.evaluate(motion.q, motion.history, Model::Want::force, response))
    return failed_newton({NewtonReport::End::inadmissible}, time);
  const Vector r = problem_.external_force(time, motion.q) - response.force - times_mass(a);
  if (!r.allFinite()) return not_finite(time);
  if (!solve_mass(r, a))
    return Failed{Failed::Cause::no_convergence, time, "the mass matrix is singular"};
  store(a, motion.a);
  store(response.force, motion.force);
  motion.stored = response.stored;
  return std::nullopt;
}

std::optional<Failed> ImplicitDynamics::step(Motion& motion, double time, double dt) {
  Balance balance(*this, motion, time, dt);
  Vector a = balance.first_guess();
  const NewtonReport report = solve_newton(balance, a, options_.newton);
  iterations_ += report.iterations;
  if (!report.converged()) return failed_newton(report, time + dt);
  balance.finish(motion);
  return std::nullopt;
}

double ImplicitDynamics::kinetic(const Motion& motion) const {
  const auto v = view(motion.v);
  return 0.5 * v.dot(times_mass(v));
}

}  // namespace abut
