#include "subdomain_solver/time/massless_layer.hpp"

#include <algorithm>
#include <limits>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "subdomain_solver/time/contact.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

namespace {

constexpr int most_iterations = 50;
constexpr int most_halvings = 8, most_trials = 20;
/// Of the largest force in the balance. A layer is small, and energy is kept to what is left.
constexpr double tolerance = 1.0e-12;

Failed inadmissible(double time) { return failed_newton({NewtonReport::End::inadmissible}, time); }

}  // namespace

MasslessLayer::MasslessLayer(const Problem& problem)
    : problem_(problem), dofs_(problem.model->massless()) {
  if (dofs_.empty()) return;
  const Eigen::Index own = static_cast<Eigen::Index>(dofs_.size()), all = problem.model->dofs();
  unit_.setIdentity(own, own);
  loads_.setZero(all);  // of jumps, the first of which may come late
  moved_.resize(index(all));
  whole_.force.setZero(all);
  whole_.history.resize(problem.model->history_size());
}

bool MasslessLayer::respond(std::span<const double> q, std::span<const double> history) {
  return problem_.model->evaluate_layer(q, history, response_);
}

/// Inverse of the layer's stiffness and its part that contact sees.
void MasslessLayer::find_compliance() {
  if (inverted_) return;
  factors_.compute(response_.tangent);
  inverse_ = factors_.solve(unit_);
  inverted_ = problem_.model->is_linear();
}

/// Adds what contact presses to the step, where the step without it would lead.
void MasslessLayer::press(double time, std::span<const double> q, Contact& contact) {
  const std::vector<int>& touched = contact.coordinates();
  const Eigen::Index n = static_cast<Eigen::Index>(touched.size());
  place_.resize(touched.size());
  for (std::size_t k = 0; k < touched.size(); ++k) {
    const auto at = std::lower_bound(dofs_.begin(), dofs_.end(), touched[k]);
    ABUT_ASSERT(at != dofs_.end() && *at == touched[k]);
    place_[k] = static_cast<int>(at - dofs_.begin());
  }
  give_.resize(n, n);
  free_.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int row = place_[index(i)];
    for (Eigen::Index k = 0; k < n; ++k) give_(i, k) = inverse_(row, place_[index(k)]);
    free_(i) = q[index(dofs_[index(row)])] + step_(row);
  }
  free_.noalias() -= give_ * pressed_;
  const Vector& force = contact.solve(time, free_, give_);
  for (Eigen::Index k = 0; k < n; ++k)
    step_.noalias() += inverse_.col(place_[index(k)]) * (force(k) - pressed_(k));
  pressed_ = force;
}

/// By part of the step; returns the largest displacement that results.
double MasslessLayer::move(std::vector<double>& q, double part) {
  double largest = 0.0;
  for (std::size_t i = 0; i < dofs_.size(); ++i) {
    double& at = q[index(dofs_[i])];
    at += part * step_(static_cast<Eigen::Index>(i));
    largest = std::max(largest, std::abs(at));
  }
  return largest;
}

/// What is not in balance, under what presses now; returns the size of the forces.
double MasslessLayer::find_rest(const Vector& loads, bool pressed) {
  rest_ = -response_.force;
  if (loads.size() > 0) {
    for (std::size_t i = 0; i < dofs_.size(); ++i)
      rest_(static_cast<Eigen::Index>(i)) += loads(dofs_[i]);
  }
  if (!pressed) return response_.force.norm();
  for (std::size_t k = 0; k < place_.size(); ++k)
    rest_(place_[k]) += pressed_(static_cast<Eigen::Index>(k));
  return std::max(response_.force.norm(), pressed_.norm());
}

/// Goes along the step: all the way, or, where forces then lead back as strongly, to where they do
/// not (regula falsi). Where a material begins to yield, tangents of both sides would lead to and
/// fro for ever. False: no admissible place was found.
bool MasslessLayer::walk(std::vector<double>& q, std::span<const double> history,
                         const Vector& loads, bool pressed) {
  find_rest(loads, pressed);
  const double begin = step_.dot(rest_);
  const double most = 0.5 * begin;
  part_ = 1.0;
  largest_ = move(q, part_);
  for (int halving = 0; !respond(q, history); ++halving) {
    if (halving == most_halvings) return false;
    part_ *= 0.5;
    largest_ = move(q, -part_);
  }
  for (int trial = 0; trial < most_trials; ++trial) {
    find_rest(loads, pressed);
    const double here = step_.dot(rest_);
    if (here >= -most) return true;
    const double next = part_ * begin / (begin - here);
    largest_ = move(q, next - part_);
    part_ = next;
    if (!respond(q, history)) return false;
  }
  return true;
}

std::optional<Failed> MasslessLayer::settle(double time, std::vector<double>& q,
                                            std::span<const double> history, const Vector& loads,
                                            Contact* contact) {
  if (contact != nullptr)
    pressed_.setZero(static_cast<Eigen::Index>(contact->coordinates().size()));
  if (!respond(q, history)) return inadmissible(time);
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const double scale = find_rest(loads, contact != nullptr && iteration > 0);
    if (!rest_.allFinite()) return not_finite(time);
    if (iteration > 0 && rest_.norm() <= std::max(tolerance * scale, problem_.model->roundoff(q)))
      return std::nullopt;
    find_compliance();
    step_.noalias() = inverse_ * rest_;
    if (contact != nullptr) press(time, q, *contact);
    if (!step_.allFinite()) return failed_newton({NewtonReport::End::singular}, time);
    if (problem_.model->is_linear()) {
      move(q, 1.0);
      return std::nullopt;
    }
    if (!walk(q, history, loads, contact != nullptr)) return inadmissible(time);
    const double least = 4.0 * std::numeric_limits<double>::epsilon() * largest_;
    if (part_ == 1.0 && step_.lpNorm<Eigen::Infinity>() <= least) return std::nullopt;
  }
  return failed_newton({NewtonReport::End::not_converged, most_iterations}, time);
}

std::optional<Failed> MasslessLayer::jump(double time, Motion& motion, const Vector& change,
                                          Vector& answer) {
  answer.setZero(change.size());
  if (std::ranges::all_of(dofs_, [&change](int dof) { return change(dof) == 0.0; }))
    return std::nullopt;
  loads_ = view(motion.force) + change;
  moved_ = motion.q;
  if (auto failed = settle(time, moved_, motion.history, loads_, nullptr)) return failed;
  if (!problem_.model->evaluate(moved_, motion.history, Model::Want::force, whole_))
    return failed_newton({NewtonReport::End::inadmissible}, time);
  answer = whole_.force - view(motion.force);
  for (const int dof : dofs_) {
    const std::size_t i = index(dof);
    motion.external_work += 0.5 * (motion.force[i] + whole_.force(dof)) * (moved_[i] - motion.q[i]);
  }
  motion.q = moved_;
  motion.stored = whole_.stored;
  store(whole_.force, motion.force);
  return std::nullopt;
}

double MasslessLayer::compliance(std::span<const double> q, std::span<const double> history,
                                 int dof) {
  const auto at = std::lower_bound(dofs_.begin(), dofs_.end(), dof);
  if (at == dofs_.end() || *at != dof || !respond(q, history)) return 0.0;
  find_compliance();
  const Eigen::Index place = at - dofs_.begin();
  return inverse_(place, place);
}

}  // namespace abut
