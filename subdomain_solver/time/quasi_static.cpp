#include "subdomain_solver/time/quasi_static.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

namespace {

/// A part solved in fewer iterations may be followed by one of twice its length.
constexpr int few_iterations = 5;
/// Times in a step that springs are stiffened.
constexpr int most_held_up = 4;

/// Of a step's work, in parts of its largest force times its way, or what roundings make of that;
/// and halvings of the step in which a kink of the force, where material begins to yield, is closed
/// in on.
constexpr double work_accuracy = 1.0e-6;
constexpr int most_bisections = 12;

}  // namespace

/// Balance of forces at a time, with the free coordinates as unknowns.
class QuasiStatic::Balance final : public Equations {
 public:
  Balance(QuasiStatic& owner, const Motion& motion, double time)
      : o_(owner), b_(owner.buffers_), motion_(motion), time_(time) {
    b_.q = view(motion.q);
    for (const Prescribed& p : o_.problem_.supports) b_.q(p.dof) = p.value(time);
  }

  /// Factors of another state would leave their rounding here.
  void forget_factors() {
    if (!o_.problem_.model->is_linear()) o_.factored_ = false;
  }

  Vector& first_guess() {
    o_.free_.pick(b_.q, b_.x);
    return b_.x;
  }
  bool finite() const { return b_.q.allFinite(); }

  /// Rigidly to where the loose motions are to be.
  void carry(Vector& x) const {
    if (o_.carries())
      x += o_.loose_ * (o_.place_ - o_.loose_.transpose() * x / static_cast<double>(x.size()));
  }

  /// The change of the prescribed coordinates drags the body along linearly, from the tangent at
  /// the begin: else the elements beside them would take all of it at once.
  [[nodiscard]] bool drag(Vector& x) {
    b_.moved = b_.q - view(motion_.q);
    if (b_.moved.isZero(0.0)) return true;
    ModelResponse& here = b_.tangent;
    Model& model = *o_.problem_.model;
    if (!model.evaluate(motion_.q, motion_.history, Model::Want::tangent, here)) return false;
    b_.sum.noalias() = here.tangent * b_.moved;
    o_.free_.pick(b_.sum, b_.pull);
    if (!factor(here.tangent) || !o_.solver_->solve(b_.pull, b_.dx)) return false;
    x -= b_.dx;
    return true;
  }

  [[nodiscard]] bool residual(const Vector& x, Vector& r, ResidualUnits& units) override {
    for (int i = 0; i < o_.free_.count(); ++i) b_.q(o_.free_.list()[i]) = x(i);
    Model& model = *o_.problem_.model;
    const std::span<const double> q = span_of(b_.q);
    if (!model.evaluate(q, motion_.history, Model::Want::force, b_.response)) return false;
    b_.external = o_.problem_.external_force(time_, q);
    o_.contact_.add_to(b_.external);
    b_.sum = b_.response.force - b_.external;
    o_.free_.pick(b_.sum, r);
    if (o_.stabilisation_) o_.stabilisation_->add_force(x, r);
    if (o_.carries()) {
      o_.unbalanced_ = -(o_.loose_.transpose() * r);
      r += o_.loose_ * o_.unbalanced_ / static_cast<double>(x.size());
    }
    units.forces = std::max(b_.response.force.norm(), b_.external.norm());
    units.roundoff = model.roundoff(q);
    b_.scale = std::max(units.forces, units.roundoff / o_.options_.newton.tolerance);
    return true;
  }

  [[nodiscard]] bool correct(const Vector& r, Vector& dx) override {
    const bool kept = o_.problem_.model->is_linear() && o_.factored_;
    if (!kept && !factor_here()) return false;
    if (!o_.solver_->solve(r, dx)) return false;
    dx = -dx;
    return true;
  }

  /// Displacements that a force adds at the tangent of the last correction.
  [[nodiscard]] bool give(const Vector& force, const Vector& place, Vector& moved, Vector& left) {
    if (!o_.factored_ && !factor_here()) return false;
    o_.free_.pick(force, b_.pull);
    left.resize(0);
    if (!(o_.loose_solver_ != nullptr ? o_.loose_solver_->solve(b_.pull, place, b_.dx, left)
                                      : o_.solver_->solve(b_.pull, b_.dx)))
      return false;
    moved.setZero(force.size());
    o_.free_.add(b_.dx, moved);
    return true;
  }

  /// Contact forces for where the balance without change of them has led. False: there are none.
  [[nodiscard]] bool press(Vector& x, int turn, double& change) {
    if (!o_.factored_ && !factor_here()) return false;
    o_.contact_.weigh(1.0, 1.0);
    return o_.contact_.press(time_, b_.q, turn, x, change);
  }

  double smallest_step(const Vector& x) const override {
    return 4.0 * std::numeric_limits<double>::epsilon() * x.lpNorm<Eigen::Infinity>();
  }

  /// False: the work of the step has no value.
  [[nodiscard]] bool finish(Motion& motion) {
    double work = 0.0;
    if (!work_of_step(work)) return false;
    motion.external_work += work;
    motion.dissipated += b_.response.dissipation;
    motion.stored = b_.response.stored;
    motion.history = b_.response.history;
    store(b_.q, motion.q);
    store(b_.response.force, motion.force);
    return true;
  }

 private:
  bool factor(const SparseMatrix& tangent) {
    o_.free_.extract(tangent, o_.matrix_);
    o_.factored_ = o_.solver_->factor(o_.matrix_);
    o_.contact_.forget();
    return o_.factored_;
  }

  [[nodiscard]] bool factor_here() {
    ModelResponse& here = b_.tangent;
    const std::span<const double> q = span_of(b_.q);
    if (!o_.problem_.model->evaluate(q, motion_.history, Model::Want::tangent, here)) return false;
    for (const std::unique_ptr<Load>& load : o_.problem_.loads)
      load->add_tangent(time_, q, here.tangent);
    return factor(here.tangent);
  }

  /// [J] that loads and supports do in the step: the integral [M.70] of the internal force along
  /// the straight way. False: an element is inverted on it.
  [[nodiscard]] bool work_of_step(double& work) {
    b_.moved = b_.q - view(motion_.q);
    const Part whole{0.0, 1.0, view(motion_.force).dot(b_.moved), b_.response.force.dot(b_.moved)};
    work = 0.5 * (whole.at_begin + whole.at_end);
    if (o_.problem_.model->is_linear()) return true;
    work = 0.0;
    double middle = 0.0;
    if (!power(0.5, middle)) return false;
    const double scale =
        std::max({std::abs(whole.at_begin), std::abs(middle), std::abs(whole.at_end)});
    const double noise = o_.problem_.model->roundoff(span_of(b_.q)) * b_.moved.norm();
    return add_work(whole, middle, std::max(work_accuracy * scale, noise), most_bisections, work);
  }

  struct Part {  // of the way, from 0 to 1
    double begin, end;
    double at_begin, at_end;  // [J] force times the whole way
    double simpson(double middle) const {
      return (end - begin) / 6.0 * (at_begin + 4.0 * middle + at_end);
    }
  };

  /// Simpson's rule on a part and on its halves, until they agree (G. F. Kuncir, 1962).
  [[nodiscard]] bool add_work(const Part& part, double middle, double accuracy, int bisections,
                              double& work) {
    const double centre = 0.5 * (part.begin + part.end);
    const Part first{part.begin, centre, part.at_begin, middle},
        second{centre, part.end, middle, part.at_end};
    double in_first = 0.0, in_second = 0.0;
    if (!power(0.5 * (part.begin + centre), in_first)) return false;
    if (!power(0.5 * (centre + part.end), in_second)) return false;
    const double halves = first.simpson(in_first) + second.simpson(in_second);
    const double change = halves - part.simpson(middle);
    if (std::abs(change) <= accuracy || bisections == 0) {
      work += halves + change / 15.0;
      return true;
    }
    return add_work(first, in_first, accuracy, bisections - 1, work) &&
           add_work(second, in_second, accuracy, bisections - 1, work);
  }

  /// [J] internal force at a part of the way, times the whole way.
  [[nodiscard]] bool power(double part, double& value) {
    b_.between = view(motion_.q) + part * b_.moved;
    ModelResponse& there = b_.on_the_way;
    if (!o_.problem_.model->evaluate(span_of(b_.between), motion_.history, Model::Want::force,
                                     there))
      return false;
    value = there.force.dot(b_.moved);
    return true;
  }

  QuasiStatic& o_;
  Buffers& b_;
  const Motion& motion_;
  double time_;
};

QuasiStatic::QuasiStatic(const Problem& problem, const Options& options,
                         std::unique_ptr<LinearSolver> solver)
    : Integrator({.statics = this}),
      problem_(problem),
      options_(options),
      free_(problem.model->dofs(), problem.supports),
      solver_(with_motions(std::move(solver))),
      contact_(free_, *solver_) {
  unbalanced_.setZero(loose_.cols());
}

std::unique_ptr<LinearSolver> QuasiStatic::with_motions(std::unique_ptr<LinearSolver> solver) {
  if (options_.loose.cols() == 0) return solver;
  const Eigen::MatrixXd motions = options_.loose(free_.list(), Eigen::all);
  const double give = options_.stabilised > 0.0 ? 1.0 / options_.stabilised : 0.0;
  if (give > 0.0)
    stabilisation_.emplace(motions, options_.stabilised, options_.at_most);
  else
    loose_ = motions;
  auto wrapped = std::make_unique<LooseSolver>(std::move(solver), motions, give);
  loose_solver_ = wrapped.get();
  return wrapped;
}

Vector QuasiStatic::place_of(const Motion& motion) const {
  Vector x;
  free_.pick(view(motion.q), x);
  return loose_.transpose() * x / static_cast<double>(x.size());
}

void QuasiStatic::carry_to(std::span<const double> place) {
  carried_ = Eigen::Map<const Vector>(place.data(), static_cast<Eigen::Index>(place.size()));
}

bool QuasiStatic::give(const Motion& motion, double time, const Vector& force, const Vector& place,
                       Vector& moved, Vector& left) {
  return Balance(*this, motion, time).give(force, place, moved, left);
}

void QuasiStatic::stabilising_force(const Motion& motion, Vector& out) const {
  out.setZero(static_cast<Eigen::Index>(motion.q.size()));
  if (stabilisation_) free_.add(stabilisation_->held(motion), out);
}

double QuasiStatic::tell_held(const Vector& force, std::span<const double> gone,
                              const Vector& acting, Motion& motion) {
  if (!stabilisation_) return 0.0;
  Vector held, way, loads;
  free_.pick(force, held);
  free_.pick(Eigen::Map<const Vector>(gone.data(), static_cast<Eigen::Index>(gone.size())), way);
  free_.pick(acting, loads);
  stabilisation_->tell(held, way, loads, motion);
  constexpr double least = 1.0e-6;  // where nothing is allowed
  return Stabilisation::told(motion).share / std::max(least, stabilisation_->at_most());
}

/// Puts down what held the loose motions in a step.
void QuasiStatic::settle(Motion& motion) {
  Vector& acting = buffers_.pull;
  free_.pick(view(motion.q), buffers_.x);
  free_.pick(buffers_.external, acting);
  stabilisation_->settle(buffers_.x, acting, motion);
}

std::optional<Failed> QuasiStatic::begin(Motion& motion, double time) {
  motion.history.resize(problem_.model->history_size(), 0.0);
  motion.a.assign(motion.q.size(), 0.0);
  motion.force.assign(motion.q.size(), 0.0);
  if (options_.joined || stabilisation_) return stand(motion, time);
  const NewtonReport report = part(motion, time, nullptr);
  if (!report.converged()) return failed_newton(report, time);
  return std::nullopt;
}

/// As it was put: what it is joined to takes part in its first equilibrium.
std::optional<Failed> QuasiStatic::stand(Motion& motion, double time) {
  ModelResponse& here = buffers_.response;
  if (!problem_.model->evaluate(motion.q, motion.history, Model::Want::force, here))
    return failed_newton({NewtonReport::End::inadmissible}, time);
  motion.stored = here.stored;
  store(here.force, motion.force);
  return std::nullopt;
}

NewtonReport QuasiStatic::part(Motion& motion, double end, Contact* contact) {
  Balance balance(*this, motion, end);
  if (!balance.finite()) return {.residual = std::numeric_limits<double>::infinity()};
  balance.forget_factors();
  Vector& x = balance.first_guess();
  if (!balance.drag(x)) return {NewtonReport::End::singular};
  balance.carry(x);
  contact_.begin(contact, motion.force);
  // Contact turns with every iteration: forces that stay while a body that they alone hold balances
  // let it fall over.
  const bool turns = contact != nullptr && !problem_.model->is_linear();
  NewtonOptions newton = options_.newton;
  if (turns) newton.max_iterations = 1;
  if (loose_solver_ != nullptr) loose_solver_->hold_up(turns);
  NewtonReport report;
  for (int turn = 0;; ++turn) {
    report = solve_newton(balance, x, newton, buffers_.newton);
    iterations_ += report.iterations;
    const bool goes_on = turns && report.end == NewtonReport::End::not_converged;
    if (contact == nullptr || !(report.converged() || goes_on)) break;
    double change = 0.0;
    if (!balance.press(x, turn, change)) return {NewtonReport::End::singular};
    if (report.converged() && change <= options_.newton.tolerance * buffers_.scale) break;
    if (turn == ContactTurns::most && report.converged() && contact_.rounded()) break;
    if (turn == ContactTurns::most)
      return {NewtonReport::End::not_converged, turn, change / buffers_.scale};
  }
  if (report.converged() && !balance.finish(motion)) return {NewtonReport::End::inadmissible};
  return report;
}

/// True: springs that the body overcame, so that it fell from one turn of contact to the next, are
/// stiffer now, along the motion that fell.
bool QuasiStatic::holds_what_falls() {
  if (!stabilisation_ || held_up_ >= most_held_up) return false;
  const Falling& falling = loose_solver_->falling();
  const double held = stabilisation_->stiffness(falling.along);
  if (!(falling.stiffness > held)) return false;
  ++held_up_;
  stabilisation_->stiffen(falling.along, 2.0 * falling.stiffness - held);
  loose_solver_->stiffen(2.0 * falling.stiffness);
  return true;
}

std::optional<Failed> QuasiStatic::step(Motion& motion, double time, double dt) {
  before_ = motion;
  const double smallest = std::ldexp(dt, -options_.most_halvings);
  double done = 0.0, length = dt;
  Vector from, to;
  if (stabilisation_) {
    free_.pick(view(before_.q), buffers_.x);
    stabilisation_->begin(buffers_.x);
    held_up_ = 0;
    loose_solver_->stiffen(0.0);
  }
  if (carries()) {
    from = place_of(before_);
    to = carried_.size() > 0 ? carried_ : from;
  }
  while (done < dt) {
    const bool last = done + length >= dt * (1.0 - 1.0e-12);
    const double end = last ? time + dt : time + done + length;
    if (carries()) place_ = last ? to : from + (end - time) / dt * (to - from);
    const NewtonReport report = part(motion, end, problem_.contact);
    if (report.converged()) {
      done = last ? dt : done + length;
      if (report.iterations <= few_iterations) length *= 2.0;
      length = std::min(length, dt - done);
      continue;
    }
    if (report.end == NewtonReport::End::not_converged && holds_what_falls()) {
      motion = before_;
      done = 0.0;
      length = dt;
      continue;
    }
    length *= 0.5;
    if (length < smallest) {
      motion = before_;
      return failed_newton(report, end, problem_.contact);
    }
  }
  if (stabilisation_) settle(motion);
  view(motion.v) = (view(motion.q) - view(before_.q)) / dt;
  return std::nullopt;
}

}  // namespace abut
