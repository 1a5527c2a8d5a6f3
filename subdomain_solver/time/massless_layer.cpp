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
/// Of what was not in balance before: factors that leave more behind are made anew.
constexpr double slow = 0.25;
constexpr int most_halvings = 8, most_trials = 20;
/// Of the largest force in the balance. A layer is small, and energy is kept to what is left.
constexpr double tolerance = 1.0e-12;

Failed inadmissible(double time) { return failed_newton({NewtonReport::End::inadmissible}, time); }

/// A body whose inner nodes lie on a line, or are one, cannot hold a surface all around it.
Failed not_held(double time) {
  Failed failed = failed_newton({NewtonReport::End::singular}, time);
  failed.detail =
      "the stiffness of the surface without mass is singular: either the body buckles there, or "
      "too few nodes inside hold it; give ports the sides that can touch alone, or the mesh three "
      "elements across";
  return failed;
}

}  // namespace

MasslessLayer::MasslessLayer(const Problem& problem)
    : problem_(problem), dofs_(problem.model->massless()) {
  if (dofs_.empty()) return;
  const Eigen::Index all = problem.model->dofs();
  factors_ = make_own_solver();
  unit_.setZero(static_cast<Eigen::Index>(dofs_.size()));
  loads_.setZero(all);  // of jumps, the first of which may come late
  moved_.resize(index(all));
  whole_.force.setZero(all);
  whole_.history.resize(problem.model->history_size());
}

bool MasslessLayer::respond(std::span<const double> q, std::span<const double> history,
                            Model::Want want) {
  if (factors_last_) want = Model::Want::force;
  return problem_.model->evaluate_layer(q, history, want, response_);
}

/// Factors of the layer's stiffness; columns of its inverse are to be found anew.
bool MasslessLayer::factor() {
  if (factors_last_) return true;
  factored_ = factors_->factor(response_.tangent);
  std::ranges::fill(known_, 0);
  ++version_;
  factors_last_ = factored_ && problem_.model->is_linear();
  return factored_;
}

const Vector* MasslessLayer::column(int k) {
  Vector& column = columns_[k];
  if (known_[k]) return &column;
  column.setZero(static_cast<Eigen::Index>(place_.size()));
  known_[k] = 1;
  const int place = place_[k];
  if (place < 0) return &column;
  unit_(place) = 1.0;
  const bool solved = factors_->solve(unit_, answer_);
  unit_(place) = 0.0;
  if (!solved) return nullptr;
  for (std::size_t i = 0; i < place_.size(); ++i)
    if (place_[i] >= 0) column(static_cast<Eigen::Index>(i)) = answer_(place_[i]);
  return &column;
}

void MasslessLayer::find_places(const Contact& contact) {
  if (touched_ == contact.coordinates()) return;
  touched_ = contact.coordinates();
  place_.resize(touched_.size());
  for (std::size_t k = 0; k < touched_.size(); ++k) {
    const auto at = std::ranges::lower_bound(dofs_, touched_[k]);
    const bool mine = at != dofs_.end() && *at == touched_[k];
    place_[k] = mine ? static_cast<int>(at - dofs_.begin()) : -1;
  }
  columns_.resize(std::max(columns_.size(), touched_.size()));
  known_.assign(touched_.size(), 0);
  ++version_;
}

/// Adds what contact presses to the step, where the step without it would lead. False: contact has
/// no answer.
bool MasslessLayer::press(double time, std::span<const double> q, Contact& contact) {
  free_.resize(pressed_.size());
  for (std::size_t i = 0; i < place_.size(); ++i) {
    const double step = place_[i] >= 0 ? step_(place_[i]) : 0.0;
    free_(static_cast<Eigen::Index>(i)) = q[touched_[i]] + step;
  }
  for (int k = 0; k < static_cast<int>(pressed_.size()); ++k) {
    if (pressed_(k) == 0.0) continue;
    const Vector* give = column(k);
    if (give == nullptr) return false;
    free_.noalias() -= pressed_(k) * *give;
  }
  const Vector* force = contact.solve(time, free_, *this);
  if (force == nullptr) return false;
  rest_.setZero();
  for (std::size_t k = 0; k < place_.size(); ++k) {
    const Eigen::Index at = static_cast<Eigen::Index>(k);
    if (place_[k] >= 0) rest_(place_[k]) = (*force)(at)-pressed_(at);
  }
  pressed_ = *force;
  if (rest_.isZero(0.0)) return true;
  if (!factors_->solve(rest_, answer_)) return false;
  step_ += answer_;
  return true;
}

/// By part of the step; returns the largest displacement that results.
double MasslessLayer::move(std::vector<double>& q, double part) {
  double largest = 0.0;
  for (std::size_t i = 0; i < dofs_.size(); ++i) {
    double& at = q[dofs_[i]];
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
    if (place_[k] >= 0) rest_(place_[k]) += pressed_(static_cast<Eigen::Index>(k));
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
  for (int halving = 0; !respond(q, history, Model::Want::force); ++halving) {
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
    if (!respond(q, history, Model::Want::force)) return false;
  }
  return true;
}

/// Factors that last are those of a linear model, as probes of other bodies are answered by.
void MasslessLayer::renew() {
  factors_last_ = factors_last_ && problem_.model->is_linear();
  factored_ = factors_last_;
}

std::optional<Failed> MasslessLayer::settle(double time, std::vector<double>& q,
                                            std::span<const double> history, const Vector& loads,
                                            Contact* contact) {
  if (contact != nullptr) {
    pressed_.setZero(static_cast<Eigen::Index>(contact->coordinates().size()));
    find_places(*contact);
  }
  // Factors cost far more than forces do: they serve as long as they lead on, from step to step
  // too, and where a material yields.
  double before = 0.0;
  if (!respond(q, history, factored_ ? Model::Want::force : Model::Want::tangent))
    return inadmissible(time);
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const double scale = find_rest(loads, contact != nullptr && iteration > 0);
    if (!rest_.allFinite()) return not_finite(time);
    // What is left is momentum that the partner gave and the body behind did not get. Steps end at
    // rounding by themselves, so that the margin of the roundings is not for here.
    const double roundoff = problem_.model->roundoff(q) / summed_roundings;
    if (iteration > 0 && rest_.norm() <= std::max(tolerance * scale, roundoff)) return std::nullopt;
    const double left = rest_.norm();
    const bool anew = !factored_ || (iteration > 0 && left > slow * before);
    if (anew && factored_ && !respond(q, history, Model::Want::tangent)) return inadmissible(time);
    if (anew && !factor()) return not_held(time);
    before = left;
    if (!factors_->solve(rest_, step_) || (contact != nullptr && !press(time, q, *contact)))
      return failed_newton({NewtonReport::End::singular}, time, contact);
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
  if (at == dofs_.end() || *at != dof || !respond(q, history, Model::Want::tangent) || !factor())
    return 0.0;
  const Eigen::Index place = at - dofs_.begin();
  unit_(place) = 1.0;
  const bool solved = factors_->solve(unit_, answer_);
  unit_(place) = 0.0;
  return solved ? answer_(place) : 0.0;
}

}  // namespace abut
