#include "subdomain_solver/time/quasi_static.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

namespace {

/// A part solved in fewer iterations may be followed by one of twice its length.
constexpr int few_iterations = 5;

}  // namespace

/// Balance of forces at a time, with the free coordinates as unknowns.
class QuasiStatic::Balance final : public Equations {
 public:
  Balance(QuasiStatic& owner, const Motion& motion, double time)
      : o_(owner), motion_(motion), time_(time), q_(view(motion.q)) {
    for (const Prescribed& p : o_.problem_.supports) q_(p.dof) = p.value(time);
  }

  Vector first_guess() const { return o_.free_.pick(q_); }
  bool finite() const { return q_.allFinite(); }

  /// The change of the prescribed coordinates drags the body along linearly, from the tangent at
  /// the begin: else the elements beside them would take all of it at once.
  [[nodiscard]] bool drag(Vector& x) {
    const Vector jump = q_ - view(motion_.q);
    if (jump.isZero(0.0)) return true;
    ModelResponse here;
    Model& model = *o_.problem_.model;
    if (!model.evaluate(motion_.q, motion_.history, Model::Want::tangent, here)) return false;
    Vector dx;
    if (!factor(here.tangent) || !o_.solver_->solve(o_.free_.pick(here.tangent * jump), dx))
      return false;
    x -= dx;
    return true;
  }

  [[nodiscard]] bool residual(const Vector& x, Vector& r, double& scale) override {
    for (int i = 0; i < o_.free_.count(); ++i)
      q_(o_.free_.list()[static_cast<std::size_t>(i)]) = x(i);
    Model& model = *o_.problem_.model;
    if (!model.evaluate(span_of(q_), motion_.history, Model::Want::force, response)) return false;
    const Vector external = o_.problem_.external_force(time_, span_of(q_));
    r = o_.free_.pick(response.force - external);
    scale = std::max({response.force.norm(), external.norm(),
                      model.roundoff(span_of(q_)) / o_.options_.newton.tolerance});
    return true;
  }

  [[nodiscard]] bool correct(const Vector& r, Vector& dx) override {
    Model& model = *o_.problem_.model;
    if (!model.is_linear() || !o_.factored_) {
      ModelResponse here;
      if (!model.evaluate(span_of(q_), motion_.history, Model::Want::tangent, here)) return false;
      for (const std::unique_ptr<Load>& load : o_.problem_.loads)
        load->add_tangent(time_, span_of(q_), here.tangent);
      if (!factor(here.tangent)) return false;
    }
    if (!o_.solver_->solve(r, dx)) return false;
    dx = -dx;
    return true;
  }

  double smallest_step(const Vector& x) const override {
    return 4.0 * std::numeric_limits<double>::epsilon() * x.lpNorm<Eigen::Infinity>();
  }

  void finish(Motion& motion) const {
    const Vector now = response.force, before = view(motion.force);
    motion.external_work += 0.5 * (now + before).dot(q_ - view(motion.q));
    motion.dissipated += response.dissipation;
    motion.stored = response.stored;
    motion.history = response.history;
    store(q_, motion.q);
    store(response.force, motion.force);
  }

  ModelResponse response;

 private:
  bool factor(const SparseMatrix& tangent) {
    o_.free_.extract(tangent, o_.matrix_);
    o_.factored_ = o_.solver_->factor(o_.matrix_);
    return o_.factored_;
  }

  QuasiStatic& o_;
  const Motion& motion_;
  double time_;
  Vector q_;
};

QuasiStatic::QuasiStatic(const Problem& problem, const Options& options,
                         std::unique_ptr<LinearSolver> solver)
    : problem_(problem),
      options_(options),
      solver_(std::move(solver)),
      free_(problem.model->dofs(), problem.supports) {}

std::optional<Failed> QuasiStatic::begin(Motion& motion, double time) {
  motion.history.resize(problem_.model->history_size(), 0.0);
  motion.a.assign(motion.q.size(), 0.0);
  motion.force.assign(motion.q.size(), 0.0);
  const NewtonReport report = part(motion, time);
  if (!report.converged()) return failed_newton(report, time);
  return std::nullopt;
}

NewtonReport QuasiStatic::part(Motion& motion, double end) {
  Balance balance(*this, motion, end);
  if (!balance.finite()) return {.residual = std::numeric_limits<double>::infinity()};
  Vector x = balance.first_guess();
  if (!balance.drag(x)) return {NewtonReport::End::singular};
  const NewtonReport report = solve_newton(balance, x, options_.newton);
  iterations_ += report.iterations;
  if (report.converged()) balance.finish(motion);
  return report;
}

std::optional<Failed> QuasiStatic::step(Motion& motion, double time, double dt) {
  const Motion before = motion;
  const double smallest = std::ldexp(dt, -options_.most_halvings);
  double done = 0.0, length = dt;
  while (done < dt) {
    const bool last = done + length >= dt * (1.0 - 1.0e-12);
    const double end = last ? time + dt : time + done + length;
    const NewtonReport report = part(motion, end);
    if (report.converged()) {
      done = last ? dt : done + length;
      if (report.iterations <= few_iterations) length *= 2.0;
      length = std::min(length, dt - done);
      continue;
    }
    length *= 0.5;
    if (length < smallest) {
      motion = before;
      return failed_newton(report, end);
    }
  }
  view(motion.v) = (view(motion.q) - view(before.q)) / dt;
  return std::nullopt;
}

}  // namespace abut
