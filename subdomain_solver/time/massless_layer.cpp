#include "subdomain_solver/time/massless_layer.hpp"

#include <algorithm>
#include <cmath>
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
/// The same where contact presses, whose rows are solved for in every correction.
constexpr double slow_contact = 0.05;
constexpr std::size_t few = 1000;  // coordinates whose factors cost some milliseconds
constexpr int most_halvings = 8, most_trials = 20;
/// Of the forces in the cells of the layer. Energy is kept to what is left, momentum to round-off.
constexpr double tolerance = 1.0e-9;
/// Roundings of one force: where some thirty cells meet in a node each adds its own some times
/// over, and what then falls no more is one of them (108 tet4 under a light push left 1.3 of one).
constexpr double of_many_cells = 16.0;
constexpr int many_iterations = 8;

Failed inadmissible(double time) { return failed_newton({NewtonReport::End::inadmissible}, time); }

/// A body whose inner nodes lie on a line, or are one, cannot hold a surface all around it.
Failed not_held(double time) {
  Failed failed = failed_newton({NewtonReport::End::singular}, time);
  failed.detail =
      "the stiffness of the surface without mass is singular: "
      "either the body buckles there, or "
      "too few nodes inside hold it; give ports the sides that can "
      "touch alone, or the mesh three "
      "elements across";
  return failed;
}

}  // namespace

MasslessLayer::MasslessLayer(const Problem& problem)
    : problem_(problem), dofs_(problem.model->massless()) {
  if (dofs_.empty()) return;
  const Eigen::Index all = problem.model->dofs();
  unit_.setZero(static_cast<Eigen::Index>(dofs_.size()));
  step_ = rest_ = asked_ = answer_ = forces_before_ = unit_;
  q_.reserve(index(all));
  history_.reserve(problem.model->history_size());
  make_room();
  loads_.setZero(all);  // of jumps, the first of which may come late
  moved_.resize(index(all));
  whole_.force.setZero(all);
  whole_.history.resize(problem.model->history_size());
}

/// Steps ask for no memory: secants are as many as they can be, once.
void MasslessLayer::make_room() {
  const Vector ones = Vector::Ones(unit_.size());
  for (int k = 0; k < 8; ++k) secants_.add(ones, 1.0, unit_, ones);
  const auto copy = [](const Vector& b, Vector& x) {
    x = b;
    return true;
  };
  static_cast<void>(secants_.solve(ones, step_, copy));
  secants_.clear();
}

void MasslessLayer::state(Archive& archive) {
  if (dofs_.empty() || linear()) return;
  archive.field("layer_place", place_);
  if (!archive.writing()) certain_ = false;
}

void MasslessLayer::release() {
  place_.clear();
  certain_ = false;
}

void MasslessLayer::forget() {
  release();
  for (Factors& kept : kept_) kept.hold = false;
}

bool MasslessLayer::respond(std::span<const double> q, std::span<const double> history,
                            Model::Want want) {
  return problem_.model->evaluate_layer(q, history, want, response_);
}

void MasslessLayer::use(std::size_t kept) {
  used_ = kept;
  certain_ = true;
  ++version_;
}

/// Whether factors of the place are among those that are kept.
bool MasslessLayer::use_kept() {
  for (const std::size_t k : {used_, 1 - used_}) {
    if (!kept_[k].hold || kept_[k].place != place_) continue;
    if (k != used_ || !certain_) use(k);
    return true;
  }
  return false;
}

/// At the place that is known. Two are kept: a body that goes back to the begin of a window goes
/// back to the factors that it had there, and then on to those that it made in it.
std::optional<Failed> MasslessLayer::make_factors(double time, std::span<const double> q,
                                                  std::span<const double> history) {
  if (use_kept()) return std::nullopt;
  if (!respond(q, history, Model::Want::tangent)) return inadmissible(time);
  const std::size_t next = kept_[used_].hold ? 1 - used_ : used_;
  Factors& made = kept_[next];
  if (made.solver == nullptr) made.solver = make_own_solver();
  made.hold = made.solver->factor(response_.tangent);
  made.place = place_;
  std::ranges::fill(made.known, 0);
  if (!made.hold) return not_held(time);
  use(next);
  // The analysis of small matrices, whose factors are changed often, is there from the begin.
  Factors& other = kept_[1 - next];
  if (linear() || other.solver != nullptr || dofs_.size() >= few) return std::nullopt;
  other.solver = make_own_solver();
  other.hold = other.solver->factor(response_.tangent);
  other.place = place_;
  return std::nullopt;
}

/// What the layer's answers depend on.
void MasslessLayer::gather(std::span<const double> q, std::span<const double> history) {
  place_.clear();
  for (const int dof : response_.coordinates) place_.push_back(q[index(dof)]);
  for (const std::size_t k : response_.history) place_.push_back(history[k]);
}

/// Those of the place that the state names.
std::optional<Failed> MasslessLayer::find_factors(double time) {
  if (use_kept()) return std::nullopt;
  const std::size_t coordinates = response_.coordinates.size();
  ABUT_ASSERT(place_.size() == coordinates + response_.history.size());
  q_.assign(index(problem_.model->dofs()), 0.0);
  history_.assign(problem_.model->history_size(), 0.0);
  for (std::size_t k = 0; k < coordinates; ++k) q_[index(response_.coordinates[k])] = place_[k];
  for (std::size_t k = 0; k < response_.history.size(); ++k)
    history_[response_.history[k]] = place_[coordinates + k];
  return make_factors(time, q_, history_);
}

/// [N] of the forces of the layer: each sums up some products, which are independent.
double MasslessLayer::roundoff(std::span<const double> q) const {
  double travel = 0.0;
  for (const int dof : response_.coordinates) travel = std::max(travel, std::abs(q[index(dof)]));
  return std::numeric_limits<double>::epsilon() * response_.force_unit *
         std::max(1.0, travel * response_.gradient_unit) *
         std::sqrt(static_cast<double>(dofs_.size()));
}

/// Factors cost far more than forces do: they serve as long as they lead on, from step to step and
/// from window to window. `slow`: they do not any more.
std::optional<Failed> MasslessLayer::renew_factors(double time, std::span<const double> q,
                                                   std::span<const double> history) {
  secants_.clear();
  if (!linear()) gather(q, history);
  return make_factors(time, q, history);
}

const Vector* MasslessLayer::column(int k) {
  Factors& f = factors();
  Vector& column = f.columns[k];
  if (f.known[k]) return &column;
  column.setZero(static_cast<Eigen::Index>(contact_place_.size()));
  f.known[k] = 1;
  const int place = contact_place_[k];
  if (place < 0) return &column;
  unit_(place) = 1.0;
  const bool solved = f.solver->solve(unit_, answer_);
  unit_(place) = 0.0;
  if (!solved) return nullptr;
  for (std::size_t i = 0; i < contact_place_.size(); ++i)
    if (contact_place_[i] >= 0) column(static_cast<Eigen::Index>(i)) = answer_(contact_place_[i]);
  return &column;
}

bool MasslessLayer::apply(const Vector& force, Vector& moved) {
  for (std::size_t k = 0; k < contact_place_.size(); ++k)
    if (contact_place_[k] >= 0) unit_(contact_place_[k]) = force(static_cast<Eigen::Index>(k));
  const bool solved = factors().solver->solve(unit_, answer_);
  unit_.setZero();
  if (!solved) return false;
  moved.setZero(static_cast<Eigen::Index>(contact_place_.size()));
  for (std::size_t k = 0; k < contact_place_.size(); ++k)
    if (contact_place_[k] >= 0) moved(static_cast<Eigen::Index>(k)) = answer_(contact_place_[k]);
  return true;
}

void MasslessLayer::find_places(const Contact& contact) {
  if (touched_ == contact.coordinates()) return;
  touched_ = contact.coordinates();
  contact_place_.resize(touched_.size());
  for (std::size_t k = 0; k < touched_.size(); ++k) {
    const auto at = std::ranges::lower_bound(dofs_, touched_[k]);
    const bool mine = at != dofs_.end() && *at == touched_[k];
    contact_place_[k] = mine ? static_cast<int>(at - dofs_.begin()) : -1;
  }
  for (Factors& kept : kept_) {
    kept.columns.resize(std::max(kept.columns.size(), touched_.size()));
    kept.known.assign(touched_.size(), 0);
  }
  ++version_;
}

/// Adds what contact presses to the step, where the step without it would lead. False: contact has
/// no answer.
bool MasslessLayer::press(double time, std::span<const double> q, Contact& contact) {
  free_.resize(pressed_.size());
  for (std::size_t i = 0; i < contact_place_.size(); ++i) {
    const double step = contact_place_[i] >= 0 ? step_(contact_place_[i]) : 0.0;
    free_(static_cast<Eigen::Index>(i)) = q[touched_[i]] + step;
  }
  if (!add_given_way(*this, -1.0, pressed_, moved_by_, free_)) return false;
  const Vector* force = contact.solve(time, free_, *this);
  if (force == nullptr) return false;
  rest_.setZero();
  for (std::size_t k = 0; k < contact_place_.size(); ++k) {
    const Eigen::Index at = static_cast<Eigen::Index>(k);
    if (contact_place_[k] >= 0) rest_(contact_place_[k]) = (*force)(at)-pressed_(at);
  }
  pressed_ = *force;
  if (rest_.isZero(0.0)) return true;
  if (!factors().solver->solve(rest_, answer_)) return false;
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
  asked_.setZero(static_cast<Eigen::Index>(dofs_.size()));
  if (loads.size() > 0) {
    for (std::size_t i = 0; i < dofs_.size(); ++i)
      asked_(static_cast<Eigen::Index>(i)) = loads(dofs_[i]);
  }
  for (std::size_t k = 0; pressed && k < contact_place_.size(); ++k)
    if (contact_place_[k] >= 0) asked_(contact_place_[k]) += pressed_(static_cast<Eigen::Index>(k));
  rest_ = asked_ - response_.force;
  return pressed ? std::max(response_.size, pressed_.norm()) : response_.size;
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

/// The balance at an iterate: whether it is enough, or how to go on.
std::optional<Failed> MasslessLayer::settle(double time, std::vector<double>& q,
                                            std::span<const double> history, const Vector& loads,
                                            Contact* contact) {
  if (contact != nullptr) {
    pressed_.setZero(static_cast<Eigen::Index>(contact->coordinates().size()));
    find_places(*contact);
  }
  if (!respond(q, history, Model::Want::force)) return inadmissible(time);
  if (place_.size() != response_.coordinates.size() + response_.history.size())
    release();  // of another body's state, or none
  if (!certain_ && !linear() && !place_.empty()) {
    if (auto failed = find_factors(time)) return failed;
    if (!respond(q, history, Model::Want::force)) return inadmissible(time);
  }
  secants_.clear();
  // Steps end at rounding by themselves, so that the margin of the roundings is not for here.
  const double rounding = linear() ? 0.0 : roundoff(q);
  double before = 0.0;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const double scale = find_rest(loads, contact != nullptr && iteration > 0);
    if (!rest_.allFinite()) return not_finite(time);
    const double left = rest_.norm();
    if (iteration > 0 && left <= std::max(tolerance * scale, rounding)) return std::nullopt;
    if (iteration > many_iterations && left <= of_many_cells * rounding) return std::nullopt;
    const bool pressed = contact != nullptr && !pressed_.isZero(0.0);
    const double most = before * (pressed ? slow_contact : slow);
    if (!factors().hold || !certain_ || (iteration > 0 && left > most)) {
      if (auto failed = renew_factors(time, q, history)) return failed;
    }
    before = left;
    // Contact knows how the layer gives way by the factor alone: what is pressed against a partner
    // would be led astray by more.
    if (pressed) secants_.clear();
    const auto solve = [this](const Vector& b, Vector& x) { return factors().solver->solve(b, x); };
    if (!secants_.solve(rest_, step_, solve) || (contact != nullptr && !press(time, q, *contact)))
      return failed_newton({NewtonReport::End::singular}, time, contact);
    if (!step_.allFinite()) return failed_newton({NewtonReport::End::singular}, time);
    if (linear()) {
      move(q, 1.0);
      return std::nullopt;
    }
    forces_before_ = response_.force;
    if (!walk(q, history, loads, contact != nullptr)) return inadmissible(time);
    secants_.add(step_, part_, forces_before_, response_.force);
    const double least = 4.0 * std::numeric_limits<double>::epsilon() * largest_;
    if (part_ == 1.0 && step_.lpNorm<Eigen::Infinity>() <= least) return std::nullopt;
  }
  const double scale = find_rest(loads, contact != nullptr);
  return failed_newton({NewtonReport::End::not_converged, most_iterations,
                        rest_.norm() / std::max(scale, std::numeric_limits<double>::min())},
                       time);
}

void MasslessLayer::lead(const Motion& motion, double dt, std::vector<double>& next) {
  if (linear()) return;
  const bool knows = !response_.heirs.empty();  // an inadmissible place is told by who balances
  if (!knows && !respond(motion.q, motion.history, Model::Want::force)) return;
  for (std::size_t i = 0; i < response_.heirs.size(); ++i)
    next[index(dofs_[i])] += dt * dt * motion.a[index(response_.heirs[i])];
}

void MasslessLayer::complete(Vector& force) {
  if (dofs_.empty() || linear()) return;
  for (std::size_t i = 0; i < dofs_.size(); ++i) {
    const double asked = asked_(static_cast<Eigen::Index>(i));
    force(response_.heirs[i]) -= asked - force(dofs_[i]);
    force(dofs_[i]) = asked;
  }
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
  complete(whole_.force);
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
  if (at == dofs_.end() || *at != dof || !respond(q, history, Model::Want::tangent)) return 0.0;
  if (here_ == nullptr) here_ = make_own_solver();
  if (!here_->factor(response_.tangent)) return 0.0;
  const Eigen::Index place = at - dofs_.begin();
  unit_(place) = 1.0;
  const bool solved = here_->solve(unit_, answer_);
  unit_(place) = 0.0;
  return solved ? answer_(place) : 0.0;
}

}  // namespace abut
