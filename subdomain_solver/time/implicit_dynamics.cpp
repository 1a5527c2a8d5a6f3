#include "subdomain_solver/time/implicit_dynamics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/assert.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

namespace {

/// How far the balance under known contact forces is solved by kept factors before contact is
/// asked: in the first turn of its scale, later of what contact last changed. More would be undone.
constexpr double first_turn = 1.0e-3, of_change = 0.03;

}  // namespace

/// Balance of momentum at the end of a step, with the free accelerations as unknowns.
class ImplicitDynamics::Balance final : public Equations {
 public:
  Balance(ImplicitDynamics& owner, const Motion& motion, double time, double dt)
      : o_(owner),
        b_(owner.buffers_),
        w_(owner.options_.weights),
        motion_(motion),
        end_(time + dt),
        dt_(dt) {
    const auto q = view(motion.q), v = view(motion.v), a = view(motion.a);
    if (o_.sums()) {  // for no acceleration
      b_.q_start = q + dt * v;
      b_.v_start = v;
    } else {  // for none at the end
      b_.q_start = q + dt * v + (0.5 - w_.beta) * dt * dt * a;
      b_.v_start = v + (1.0 - w_.gamma) * dt * a;
    }
    kept_ = o_.remember(motion, dt);
    see_past(time);
  }

  /// What the forces of the step's begin add to the balance.
  void see_past(double time) {
    const double share = o_.sums() ? 1.0 : w_.alpha_f;
    o_.times_mass(view(motion_.a), b_.inertia);
    b_.past = w_.alpha_m * b_.inertia;
    if (w_.is_newmark() && !o_.sums()) return;
    b_.external_start = o_.problem_.external_force(time, motion_.q);
    b_.past += share * (view(motion_.force) - b_.external_start);
    // Without mass there was balance at the begin, contact included.
    for (const int dof : o_.layer_.dofs()) b_.past(dof) = 0.0;
  }

  Vector& first_guess() {
    b_.a = (o_.sums() ? 2.0 : 1.0) * view(motion_.a);
    follow_supports();
    o_.free_.pick(b_.a, b_.x);
    return b_.x;
  }

  /// Whether corrections are by factors of an earlier state, and another solve begins with them.
  bool kept() const { return kept_; }
  void begin_solve() { last_ = std::numeric_limits<double>::infinity(); }

  /// Where Newton's method got nowhere: nodes without mass keep no acceleration, so under large
  /// ones of the others the first guess may strain or invert their cells. As if there were none at
  /// all, and then where the step began; before all that, by factors of its own. False: all were
  /// tried.
  [[nodiscard]] bool guess_again(int turn) {
    if (std::exchange(kept_, false)) {
      first_guess();
      return true;
    }
    if (turn > 0 || guesses_ == 2) return false;
    if (++guesses_ == 1) {
      b_.a.setZero();
    } else {
      b_.a = (view(motion_.q) - b_.q_start) / (w_.beta * dt_ * dt_);
    }
    follow_supports();
    o_.free_.pick(b_.a, b_.x);
    return true;
  }

  void follow_supports() {
    for (const Prescribed& p : o_.problem_.supports)
      b_.a(p.dof) = (p.value(end_) - b_.q_start(p.dof)) / (w_.beta * dt_ * dt_);
  }

  [[nodiscard]] bool residual(const Vector& x, Vector& r, ResidualUnits& units) override {
    for (int i = 0; i < o_.free_.count(); ++i) b_.a(o_.free_.list()[i]) = x(i);
    b_.q = b_.q_start + w_.beta * dt_ * dt_ * b_.a;
    Model& model = *o_.problem_.model;
    const std::span<const double> q = span_of(b_.q);
    if (!model.evaluate(q, motion_.history, Model::Want::force, b_.response)) return false;
    b_.external = o_.problem_.external_force(end_, q);
    o_.contact_.add_to(b_.external);
    o_.times_mass(b_.a, b_.inertia);
    b_.inertia *= 1.0 - w_.alpha_m;
    b_.inner = (1.0 - w_.alpha_f) * b_.response.force;
    b_.outer = (1.0 - w_.alpha_f) * b_.external;
    b_.sum = b_.inertia + b_.inner - b_.outer + b_.past;
    o_.free_.pick(b_.sum, r);
    units.forces = std::max({b_.inertia.norm(), b_.inner.norm(), b_.outer.norm(), b_.past.norm()});
    units.roundoff = model.roundoff(q);
    b_.scale = std::max(units.forces, units.roundoff / o_.options_.newton.tolerance);
    return true;
  }

  [[nodiscard]] bool correct(const Vector& r, Vector& dx) override {
    // Where factors of another state lead on too slowly, those of this one do.
    const double size = r.norm();
    kept_ = kept_ && size <= enough_ * last_;
    last_ = size;
    const bool linear = o_.problem_.model->is_linear() && o_.factored_dt_ == dt_;
    if (!linear && !(kept_ ? o_.factor_remembered() : factor())) return false;
    if (!o_.solver_->solve(r, dx)) return false;
    dx = -dx;
    return true;
  }

  [[nodiscard]] bool factor() {
    Model& model = *o_.problem_.model;
    ModelResponse& here = b_.tangent;
    const std::span<const double> q = span_of(b_.q);
    if (!model.evaluate(q, motion_.history, Model::Want::tangent, here)) return false;
    for (const std::unique_ptr<Load>& load : o_.problem_.loads)
      load->add_tangent(end_, q, here.tangent);
    const SparseMatrix& whole = o_.whole_.of(
        1.0 - w_.alpha_m, o_.mass_, (1.0 - w_.alpha_f) * w_.beta * dt_ * dt_, here.tangent);
    return o_.factor(whole, dt_);
  }

  /// Contact forces for where the balance without change of them has led. False: there are none.
  [[nodiscard]] bool press(Vector& x, int turn, double& change) {
    if (kept_ ? !o_.factor_remembered() : o_.factored_dt_ != dt_ && !factor()) return false;
    o_.contact_.weigh(1.0 - w_.alpha_f, w_.beta * o_.factored_dt_ * o_.factored_dt_);
    return o_.contact_.press(end_, b_.q, turn, x, change);
  }

  /// Of accelerations: their own rounding, and that of the displacements that they move.
  double smallest_step(const Vector& x) const override {
    const double moved = b_.q.lpNorm<Eigen::Infinity>() / (w_.beta * dt_ * dt_);
    return 4.0 * std::numeric_limits<double>::epsilon() *
           std::max(x.lpNorm<Eigen::Infinity>(), moved);
  }

  void finish(Motion& motion) {
    b_.v = b_.v_start + w_.gamma * dt_ * b_.a;
    motion.external_work += external_work();
    motion.dissipated += b_.response.dissipation;
    motion.stored = b_.response.stored;
    motion.history = b_.response.history;
    if (o_.keeps_factors()) {  // those that led too slowly are forgotten
      motion.control.clear();
      if (kept_) motion.control = o_.remembered_;
    }
    store(b_.q, motion.q);
    store(b_.v, motion.v);
    if (o_.sums()) b_.a *= 0.5;
    store(b_.a, motion.a);
    store(b_.response.force, motion.force);
    // Their velocity is that of the step: nothing but traces reads it.
    for (const int dof : o_.layer_.dofs()) {
      motion.v[dof] = b_.moved(dof) / dt_;
      motion.a[dof] = 0.0;
    }
  }

 private:
  /// [J] of the step, by loads and supports: what inertia and internal force take. With other
  /// weights than Newmark's these take damping too, and accelerations lag by (alpha_f - alpha_m)
  /// dt, so free coordinates are worked on by the loads, and supports see the lag made good.
  double external_work() {
    const auto a = view(motion_.a), force = view(motion_.force);
    b_.moved = b_.q - view(motion_.q);
    if (w_.is_newmark()) {
      o_.times_mass(b_.a, b_.inner);
      if (o_.sums()) {
        b_.outer.setZero(b_.inner.size());
      } else {
        o_.times_mass(a, b_.outer);
      }
      b_.inner = b_.response.force + b_.inner;
      b_.outer = force + b_.outer;
      return 0.5 * (b_.inner + b_.outer).dot(b_.moved);
    }
    const double late = 0.5 - w_.alpha_m + w_.alpha_f;
    b_.inner = late * b_.a + (1.0 - late) * a;
    o_.times_mass(b_.inner, b_.inertia);
    Vector& mean = b_.sum;
    mean = 0.5 * (b_.response.force + force) + b_.inertia;
    for (int i : o_.inertial_.list()) mean(i) = 0.5 * (b_.external(i) + b_.external_start(i));
    return mean.dot(b_.moved);
  }

  ImplicitDynamics& o_;
  Buffers& b_;
  const AlphaWeights& w_;
  const Motion& motion_;
  double end_, dt_;
  int guesses_ = 0;  // beside the first
  bool kept_ = false;
  double last_ = 0.0;                     // [N] residual before the last correction of this solve
  static constexpr double enough_ = 0.1;  // of it may be left by factors of another state
};

/// A tangent tells how bodies go on that are not linear and keep no accelerations.
Integrator::Abilities ImplicitDynamics::abilities(const Problem& problem, const Options& options) {
  const bool layered = !problem.model->massless().empty();
  const bool sums = options.accelerations == Accelerations::summed;
  const bool tells = sums && !problem.model->is_linear() && !layered;
  return {.inertia = this,
          .layer = layered ? &layer_ : nullptr,
          .foreseeing = tells ? this : nullptr,
          .lag = MomentumLag::exists(options.weights) ? &lag_ : nullptr,
          .accelerates_without_ties = options.accelerations == Accelerations::steady};
}

ImplicitDynamics::ImplicitDynamics(const Problem& problem, const Options& options,
                                   std::unique_ptr<LinearSolver> solver)
    : Integrator(abilities(problem, options)),
      problem_(problem),
      options_(options),
      solver_(std::move(solver)),
      free_(problem.model->dofs(), problem.supports),
      inertial_(problem.model->dofs(), problem.supports, problem.model->massless()),
      layer_(problem),
      contact_(free_, *solver_),
      lag_(options.weights, mass_, inertial_.list(),
           options.accelerations == Accelerations::steady ? problem.model->massless()
                                                          : std::vector<int>()) {
  ABUT_ASSERT(options.accelerations != Accelerations::summed || options.weights.is_trapezoidal());
  mass_ = mass_matrix(*problem.model, options.mass);
  if (!layer_.empty()) of_mass_.answer.setZero(problem.model->dofs());
}

void ImplicitDynamics::times_mass(const Eigen::Ref<const Vector>& x, Vector& out) const {
  out.noalias() = mass_ * x;
}

/// Adds the solution of M a = f on the free coordinates that have mass.
bool ImplicitDynamics::solve_mass(const Vector& force, Vector& acceleration) const {
  if (!mass_solver_) {
    SparseMatrix free_mass;
    FreeCoordinates(problem_.model->dofs(), problem_.supports, layer_.dofs())
        .extract(mass_, free_mass);
    // A mass matrix is never far from its diagonal: some twenty iterations.
    mass_solver_ = free_mass.rows() > most_factored ? make_conjugate_gradients(1.0e-14)
                                                    : make_direct_solver();
    if (!mass_solver_->factor(free_mass)) return false;
  }
  inertial_.pick(force, of_mass_.force);
  if (!mass_solver_->solve(of_mass_.force, of_mass_.free)) return false;
  inertial_.add(of_mass_.free, acceleration);
  return true;
}

std::optional<Failed> ImplicitDynamics::jump(Motion& motion, double time, const Vector& change) {
  Vector& rest = of_mass_.rest;
  rest = change;
  if (!layer_.empty()) {
    if (auto failed = layer_.jump(time, motion, change, of_mass_.answer)) return failed;
    rest -= of_mass_.answer;
  }
  if (sums()) return std::nullopt;
  Vector& a = of_mass_.acceleration;
  a = view(motion.a);
  const bool solved = solve_mass(rest, a);
  ABUT_ASSERT(solved);  // as at the begin
  store(a, motion.a);
  return std::nullopt;
}

void ImplicitDynamics::strike(Motion& motion, const Vector& impulse) {
  Vector& change = of_mass_.acceleration;
  change.setZero(impulse.size());
  const bool solved = solve_mass(impulse, change);
  ABUT_ASSERT(solved);  // as at the begin
  view(motion.v) += change;
}

/// Newmark's are those of the balance at every step's end. With other weights they lag, and sums
/// tell of none: the balance is solved for them.
void ImplicitDynamics::acceleration(const Motion& motion, double time, double step,
                                    const Vector& external, Vector& out) const {
  if (options_.weights.is_newmark() && !sums()) {
    out = view(motion.a);
    return;
  }
  out.setZero(static_cast<Eigen::Index>(motion.q.size()));
  problem_.set_accelerations(time, step, out);
  times_mass(out, of_mass_.rest);
  of_mass_.rest = external - view(motion.force) - of_mass_.rest;
  const bool solved = solve_mass(of_mass_.rest, out);
  ABUT_ASSERT(solved);  // as at the begin
}

/// Accelerations from the balance at the begin: M a = f - r on the free coordinates. Those of
/// prescribed ones are the motion's own; none are given: zero.
std::optional<Failed> ImplicitDynamics::begin(Motion& motion, double time) {
  Model& model = *problem_.model;
  ModelResponse response;
  motion.history.resize(model.history_size(), 0.0);
  motion.a.resize(motion.q.size(), 0.0);
  Vector& a = of_mass_.acceleration;  // jump finds it grown
  a.setZero(model.dofs());
  for (const Prescribed& p : problem_.supports) {
    motion.q[p.dof] = p.value(time);
    a(p.dof) = motion.a[p.dof];
  }
  if (!layer_.empty()) {
    const Vector& loads = problem_.external_force(time, motion.q);
    if (auto failed = layer_.settle(time, motion.q, motion.history, loads, nullptr)) return failed;
  }
  if (!model.evaluate(motion.q, motion.history, Model::Want::force, response))
    return failed_newton({NewtonReport::End::inadmissible}, time);
  Vector r;
  times_mass(a, r);
  r = problem_.external_force(time, motion.q) - response.force - r;
  if (!r.allFinite()) return not_finite(time);
  if (!solve_mass(r, a))
    return Failed{Failed::Cause::no_convergence, time, "the mass matrix is singular"};
  store(a, motion.a);
  store(response.force, motion.force);
  motion.stored = response.stored;
  return std::nullopt;
}

NewtonReport ImplicitDynamics::solve(Balance& balance, const Motion& motion) {
  Vector& x = balance.first_guess();
  contact_.begin(problem_.contact, motion.force);
  const NewtonOptions& asked = options_.newton;
  NewtonOptions now = asked;
  if (problem_.contact != nullptr && balance.kept())
    now.tolerance = std::max(first_turn, asked.tolerance);
  for (int turn = 0;; ++turn) {
    NewtonReport report;
    do {
      balance.begin_solve();
      report = solve_newton(balance, x, now, buffers_.newton);
      iterations_ += report.iterations;
    } while (!report.converged() && balance.guess_again(turn));
    const bool whole = now.tolerance == asked.tolerance;
    // Newton's own last correction leaves far less than is asked for; these do after another one.
    if (report.converged() && balance.kept() && report.iterations > 0 && whole) {
      balance.begin_solve();
      report = solve_newton(balance, x, asked, buffers_.newton);
    }
    if (!report.converged() || problem_.contact == nullptr) return report;
    double change = 0.0;
    if (!balance.press(x, turn, change)) return {NewtonReport::End::singular};
    if (whole && change <= asked.tolerance * buffers_.scale) return report;
    if (turn == ContactTurns::most)
      return {NewtonReport::End::not_converged, turn, change / buffers_.scale};
    now.tolerance = asked.tolerance;
    if (balance.kept())
      now.tolerance = std::max(of_change * change / buffers_.scale, asked.tolerance);
  }
}

std::optional<Failed> ImplicitDynamics::step(Motion& motion, double time, double dt) {
  Balance balance(*this, motion, time, dt);
  const NewtonReport report = solve(balance, motion);
  if (!report.converged()) return failed_newton(report, time + dt, problem_.contact);
  balance.finish(motion);
  return std::nullopt;
}

double ImplicitDynamics::kinetic(const Motion& motion) const {
  const auto v = view(motion.v);
  times_mass(v, of_mass_.rest);
  return 0.5 * v.dot(of_mass_.rest);
}

}  // namespace abut
