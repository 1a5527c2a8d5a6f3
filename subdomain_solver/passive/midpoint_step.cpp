#include "subdomain_solver/passive/midpoint_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "subdomain_solver/solve/matrix_sum.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

namespace {

constexpr int most_midpoint_iterations = 100, most_halvings = 40;
/// Corrections of a linear body: factors are of a length that differs by 1e-7 at most, and each of
/// them gains as many digits.
constexpr int most_corrections = 6;
/// Steps whose potential falls by less than so many roundings of the energy are at its bottom; one
/// or two more of them may yet gain digits of the balance.
constexpr double at_bottom = 100.0;
constexpr int last_steps = 2;
constexpr std::size_t most_factors = 3;
/// A tangent is kept while it foretells that so many corrections are enough.
constexpr double most_corrections_left = 4.0;
/// Right-hand sides that are solved for at once.
constexpr std::size_t together = 64;

/// Lengths of windows' parts differ in their last bits: those of one length share factors. A
/// function of the length alone, so that a reply does not depend on what came before.
double shared_length(double length) {
  constexpr int bits = 24;
  int exponent = 0;
  const double mantissa = std::frexp(length, &exponent);
  return std::ldexp(std::round(std::ldexp(mantissa, bits)), exponent - bits);
}

/// Whether another tangent is worth its price: `before` and `now` are sizes of the balance before
/// and after a correction, `least` is that at which no more are needed.
bool converges_slowly(double before, double now, double least) {
  if (now <= at_bottom * least) return false;
  const double ratio = now / before;
  return ratio >= 1.0 || std::log(least / now) < most_corrections_left * std::log(ratio);
}

}  // namespace

bool MidpointStep::FreeStep::is_of(const Motion& motion, double from, double until) const {
  return start == from && end == until && q == motion.q && v == motion.v &&
         history == motion.history;
}

MidpointStep::MidpointStep(Body body)
    : body_(std::move(body)),
      free_(body_.problem->model->dofs(), body_.problem->supports),
      mass_(body_.mass),
      inertia_(diagonal_matrix(mass_)) {}

void MidpointStep::loosen(int looser) {
  ABUT_ASSERT(body_.rests || looser == 0);
  if (looser == looser_) return;
  looser_ = looser;
  mass_ = std::ldexp(1.0, -2 * looser) * body_.mass;
  inertia_ = diagonal_matrix(mass_);
  factors_.clear();
  unpushed_.end = unpushed_.start - 1.0;  // of no step
}

std::optional<Failed> MidpointStep::step(Motion& motion, double start, double end,
                                         const Vector& impulse) {
  start_ = start;
  end_ = end;
  length_ = end - start;
  begin(motion, start, impulse);
  if (!given_.allFinite() || !std::ranges::all_of(held_, [](double u) { return std::isfinite(u); }))
    return not_finite(end);
  auto failed = body_.cells == nullptr ? solve_linear(motion) : solve(motion, impulse);
  if (!failed) failed = body_.rests ? rest(motion, impulse) : finish(motion, impulse);
  return failed;
}

/// The first guess is the free motion. Supports' mean velocity is that of their way; those of a
/// body that rests are at its end in the middle.
void MidpointStep::begin(const Motion& motion, double start, const Vector& impulse) {
  change_.setZero(mass_.size());
  held_.clear();
  const double ways = body_.rests ? 2.0 : 1.0;
  for (const Prescribed& p : body_.problem->supports) {
    held_.push_back(p.value(end_) - motion.q[p.dof]);
    change_(p.dof) = 2.0 * (ways * held_.back() / length_ - motion.v[p.dof]);
  }
  follow(motion);
  loads_.setZero(mass_.size());
  const double at = body_.rests ? end_ : start + 0.5 * length_;
  for (const Load* load : body_.loads) load->add(at, middle_, loads_);
  given_ = impulse + length_ * loads_;
}

/// The middle of the step.
void MidpointStep::follow(const Motion& motion) {
  middle_.resize(motion.q.size());
  view(middle_) = view(motion.q) + 0.5 * length_ * (view(motion.v) + 0.5 * change_);
}

bool MidpointStep::respond(const Motion& motion) {
  follow(motion);
  return body_.problem->model->evaluate(middle_, motion.history, Model::Want::force, response_) &&
         std::isfinite(response_.stored);
}

/// Whose derivative by the change of velocity is a quarter of the balance.
double MidpointStep::potential() {
  constexpr double digits = 2.0e-15;  // of sums over many coordinates
  double moving = 0.0, given = 0.0;
  for (const int i : free_.list()) {
    moving += 0.125 * mass_(i) * change_(i) * change_(i);
    given += 0.25 * given_(i) * change_(i);
  }
  const double inner = response_.stored + response_.dissipation;
  // Places are rounded too: of cells that are crushed to nearly nothing forces work on that.
  double placed = 0.0;
  for (const int i : free_.list()) placed += std::abs(response_.force(i) * middle_[i]);
  rounding_ = body_.noise + digits * (moving + std::abs(given) + std::abs(inner) + placed);
  return moving - given + inner;
}

/// Of the balance of momentum on the free coordinates. Returns its size.
double MidpointStep::residual() {
  left_.resize(free_.count());
  for (int k = 0; k < free_.count(); ++k) {
    const int i = free_.list()[k];
    left_(k) = given_(i) - length_ * response_.force(i) - mass_(i) * change_(i);
  }
  return left_.norm();
}

/// [kg m/s] below which the balance cannot be improved.
double MidpointStep::roundoff() {
  double sum = 0.0;
  for (const int i : free_.list()) {
    const double part = std::abs(given_(i)) + std::abs(mass_(i) * change_(i));
    sum += part * part;
  }
  return length_ * body_.problem->model->roundoff(middle_) +
         std::numeric_limits<double>::epsilon() * std::sqrt(sum);
}

/// Corrections with one factor until the balance no longer improves.
std::optional<Failed> MidpointStep::solve_linear(const Motion& motion) {
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_corrections; ++i) {
    if (!respond(motion)) return failed_newton({NewtonReport::End::inadmissible}, end_);
    const double now = residual();
    if (!std::isfinite(now)) return not_finite(end_);
    if (now == 0.0 || now > 0.5 * before) break;
    before = now;
    Factors* factors = this->factors();
    if (factors == nullptr || !factors->solver->solve(left_, correction_))
      return failed_newton({NewtonReport::End::singular}, end_);
    free_.add(correction_, change_);
  }
  return respond(motion) ? std::nullopt
                         : std::optional(failed_newton({NewtonReport::End::inadmissible}, end_));
}

/// From the free step, whose tangent is the first one.
std::optional<Failed> MidpointStep::solve(const Motion& motion, const Vector& impulse) {
  if (!unpushed_.is_of(motion, start_, end_)) {
    find_free_step(motion);
    answered_ = false;
  }
  given_ = impulse + length_ * loads_;
  const bool pushed = (impulse.array() != 0.0).any();
  if (pushed && again_ && answered_ && go_on(motion)) return std::nullopt;
  own_.made = answered_ = false;
  present_ = &unpushed_.factors;
  next_ = &own_;
  if (unpushed_.failed && !pushed) return unpushed_.failed;
  std::optional<Failed> failed;
  if (unpushed_.failed) {
    present_ = next_;
    failed = solve_from_begin(motion);
  } else {
    change_ = unpushed_.change;
    if (!respond(motion)) return failed_newton({NewtonReport::End::inadmissible}, end_);
    if (pushed) failed = iterate(motion);
  }
  answered_ = pushed && !failed;
  if (answered_) answer_ = change_;
  return failed;
}

/// From the last answer, which differs by less and less as impulses settle. Bodies that are crushed
/// so far that rounding ends the search before there is balance go the longer way each time: what
/// they answer depends on it, and small steps have an answer more often (ends of crushed bars: in 6
/// of 7 runs instead of 2).
bool MidpointStep::go_on(const Motion& motion) {
  if (!present_->made) present_ = next_;  // the free step's is of its own place
  change_ = answer_;
  if (!respond(motion) || iterate(motion) || !balanced_) return false;
  answer_ = change_;
  return true;
}

void MidpointStep::find_free_step(const Motion& motion) {
  given_ = length_ * loads_;
  own_.made = unpushed_.factors.made = false;
  present_ = next_ = &own_;
  unpushed_.failed = solve_from_begin(motion);
  unpushed_.change = change_;
  unpushed_.start = start_;
  unpushed_.end = end_;
  unpushed_.q = motion.q;
  unpushed_.v = motion.v;
  unpushed_.history = motion.history;
}

/// From the motion without forces.
std::optional<Failed> MidpointStep::solve_from_begin(const Motion& motion) {
  if (!respond(motion)) {  // it inverts cells: from where the step began
    for (const int i : free_.list()) change_(i) = -2.0 * motion.v[i];
    if (!respond(motion)) return failed_newton({NewtonReport::End::inadmissible}, end_);
  }
  return iterate(motion);
}

std::optional<Failed> MidpointStep::iterate(const Motion& motion) {
  reached_ = potential();
  NewtonReport report{NewtonReport::End::not_converged};
  double before = std::numeric_limits<double>::infinity();
  bool afresh = false;
  balanced_ = false;
  for (int small = 0; report.iterations < most_midpoint_iterations; ++report.iterations) {
    const double size = residual(), least = roundoff();
    if (!std::isfinite(size)) return not_finite(end_);
    balanced_ = size <= least;
    if (balanced_) return std::nullopt;
    afresh = afresh || !present_->made || converges_slowly(before, size, least);
    before = size;
    if (!correct(motion, afresh)) return failed_newton({NewtonReport::End::singular}, end_);
    const double slope = 0.25 * left_.dot(correction_);  // by which the potential falls
    if (slope < at_bottom * rounding_ && ++small > last_steps) return std::nullopt;
    switch (search(motion, slope)) {
      case Search::moved:
        afresh = part_ < 1.0;
        break;
      case Search::ended:
        return std::nullopt;
      case Search::stuck:
        if (!std::exchange(afresh, true)) break;  // by a tangent of another place
        report.residual = size / std::max(given_.norm(), mass_.maxCoeff());
        return failed_newton(report, end_);
    }
  }
  report.residual = residual() / std::max(given_.norm(), mass_.maxCoeff());
  return failed_newton(report, end_);
}

/// Halves the correction until the potential has fallen, but for its rounding.
MidpointStep::Search MidpointStep::search(const Motion& motion, double slope) {
  constexpr double enough = 1.0e-4;  // of the fall that the slope foretells
  before_ = change_;
  part_ = 1.0;
  for (int k = 0; k <= most_halvings; ++k, part_ *= 0.5) {
    change_ = before_;
    for (int i = 0; i < free_.count(); ++i) change_(free_.list()[i]) += part_ * correction_(i);
    if (!respond(motion)) continue;
    const double now = potential();
    if (!(now <= reached_ - enough * part_ * slope + rounding_)) continue;
    reached_ = now;
    return Search::moved;
  }
  change_ = before_;
  const bool back = respond(motion);
  constexpr double near = 1.0e4;  // roundings of the energy, at which the search may end
  return back && slope < near * rounding_ ? Search::ended : Search::stuck;
}

/// Of the middle of the step, from the history at its begin. The tangent itself, so that Newton's
/// method stays one, where it is definite with the inertia; else cell by cell what is of it.
bool MidpointStep::factor(std::span<const double> history, Factors& factors) {
  if (factors.solver == nullptr) factors.solver = make_direct_solver(Pivots::definite);
  factors.columns.clear();
  const double share = 0.25 * length_ * length_;
  if (!body_.cells->evaluate(middle_, history, Model::Want::tangent, curved_)) return false;
  free_.extract(inertia_ + share * curved_.tangent, matrix_);
  factors.made = factors.solver->factor(matrix_);
  if (factors.made) return true;
  if (!body_.cells->definite_tangent(middle_, history, 1.0 / share, tangent_)) return false;
  free_.extract(inertia_ + share * tangent_, matrix_);
  factors.made = factors.solver->factor(matrix_);
  return factors.made;
}

bool MidpointStep::correct(const Motion& motion, bool afresh) {
  if (afresh && present_->made) present_ = next_;
  if (afresh && !factor(motion.history, *present_)) return false;
  return present_->solver->solve(left_, correction_);
}

/// Of a linear body at the step's length. Null: there are none.
MidpointStep::Factors* MidpointStep::factors() {
  const double length = shared_length(length_);
  const auto found = std::ranges::find(factors_, length, &Factors::length);
  if (found != factors_.end()) {
    std::rotate(found, found + 1, factors_.end());
    return &factors_.back();
  }
  if (tangent_.size() == 0) {
    ModelResponse rest;
    const std::vector<double> still(index(mass_.size()), 0.0);
    if (!body_.problem->model->evaluate(still, {}, Model::Want::tangent, rest)) return nullptr;
    tangent_ = rest.tangent;
  }
  SparseMatrix whole = inertia_ + 0.25 * length * length * tangent_, reduced;
  FreeCoordinates(static_cast<int>(mass_.size()), body_.problem->supports).extract(whole, reduced);
  Factors made{length, make_direct_solver(Pivots::every), {}, true};
  if (!made.solver->factor(reduced)) return nullptr;
  if (factors_.size() == most_factors) factors_.erase(factors_.begin());
  factors_.push_back(std::move(made));
  return &factors_.back();
}

/// Energies at the step's end. What acts on free coordinates works by the mean force of the step;
/// a support does what the body answers there, and carries its own mass.
std::optional<Failed> MidpointStep::finish(Motion& motion, const Vector& impulse) {
  Model& model = *body_.problem->model;
  const auto v = view(std::as_const(motion).v);
  moved_.resize(motion.q.size());
  view(moved_) = length_ * (v + 0.5 * change_);
  std::size_t k = 0;
  for (const Prescribed& p : body_.problem->supports) moved_[p.dof] = held_[k++];
  last_.resize(motion.q.size());
  view(last_) = view(motion.q) + view(moved_);
  const Vector mean = response_.force;  // [N]
  if (!model.evaluate(last_, motion.history, Model::Want::force, response_))
    return failed_newton({NewtonReport::End::inadmissible}, end_);
  double work = 0.0;
  for (const int i : free_.list()) work += loads_(i) * moved_[i];
  motion.force.assign(motion.q.size(), 0.0);
  for (const Prescribed& p : body_.problem->supports) {
    const std::size_t i = index(p.dof);
    const double before = motion.v[i], after = moved_[i] / length_, mass = mass_(p.dof);
    const double answer = mean(p.dof) - impulse(p.dof) / length_;
    work += answer * moved_[i] + 0.5 * mass * (after * after - before * before);
    motion.force[i] = answer - loads_(p.dof) + mass * (after - before) / length_;
    change_(p.dof) = after - before;
  }
  view(motion.v) += change_;
  motion.q.swap(last_);
  motion.external_work += work;
  motion.dissipated += response_.dissipation;
  motion.stored = response_.stored;
  motion.history.swap(response_.history);  // compliance() needs that of the begin
  return std::nullopt;
}

/// The middle is the end. Loads and supports work by the means of their forces before and after:
/// supports go their way in the first of the steps from one instant to another, and what they bear
/// at its end is found by the last.
std::optional<Failed> MidpointStep::rest(Motion& motion, const Vector& impulse) {
  moved_.resize(motion.q.size());
  view(moved_) = view(middle_) - view(motion.q);
  Vector loads = Vector::Zero(loads_.size());  // [N] before
  for (const Load* load : body_.loads) load->add(start_, motion.q, loads);
  loads = 0.5 * (loads + loads_);
  double work = 0.0;
  for (const int i : free_.list()) work += loads(i) * moved_[i];
  std::vector<double> borne(motion.q.size(), 0.0);
  if (gone_.start != start_ || gone_.end != end_) gone_ = {start_, end_, borne};
  for (const Prescribed& p : body_.problem->supports) {
    const std::size_t i = index(p.dof);
    const double answer = response_.force(p.dof) - impulse(p.dof) / length_;
    borne[i] = answer - loads_(p.dof);
    if (moved_[i] != 0.0) {
      gone_.way[i] = moved_[i];
      work += (0.5 * (motion.force[i] + borne[i]) + loads(p.dof)) * moved_[i];
    } else {
      work += 0.5 * (borne[i] - motion.force[i]) * gone_.way[i];
    }
  }
  motion.force.swap(borne);
  motion.q = middle_;
  std::ranges::fill(motion.v, 0.0);
  motion.external_work += work;
  motion.dissipated += response_.dissipation;
  motion.stored = response_.stored;
  motion.history.swap(response_.history);  // compliance() needs that of the begin
  return std::nullopt;
}

bool MidpointStep::find_columns(const Motion& motion, const PortMap& ports, LinearSolver& solver,
                                std::span<const std::size_t> values,
                                std::vector<std::vector<double>>& columns) {
  std::vector<double> unit(ports.values(), 0.0), whole(motion.v.size(), 0.0);
  Vector lifted, picked;
  Eigen::MatrixXd right(free_.count(), static_cast<Eigen::Index>(values.size())), answer;
  for (std::size_t k = 0; k < values.size(); ++k) {
    unit[values[k]] = 1.0;
    lifted.setZero(mass_.size());
    ports.lift(motion.q, unit, lifted);
    unit[values[k]] = 0.0;
    free_.pick(lifted, picked);
    right.col(static_cast<Eigen::Index>(k)) = picked;
  }
  if (!solver.solve_columns(right, answer)) return false;
  for (Eigen::Index k = 0; k < answer.cols(); ++k) {
    const double mean = body_.rests ? 0.25 : 0.5;  // of a change of velocity: moved over length
    for (int i = 0; i < free_.count(); ++i) whole[free_.list()[i]] = mean * answer(i, k);
    ports.velocity(motion.q, whole, columns.emplace_back());
  }
  return true;
}

bool MidpointStep::compliance(const Motion& motion, const PortMap& ports,
                              const std::vector<std::size_t>& values, std::vector<double>& out) {
  out.assign(values.size() * values.size(), 0.0);
  if (values.empty()) return true;
  Factors* factors = body_.cells == nullptr ? this->factors() : present_;
  if (factors == nullptr || (!factors->made && !factor(response_.history, *factors))) return false;
  std::map<std::size_t, std::vector<double>>& known = factors->columns;
  std::vector<std::size_t> wanted;
  std::ranges::copy_if(values, std::back_inserter(wanted),
                       [&](std::size_t value) { return !known.contains(value); });
  // Those that are kept one by one: their bits must not depend on who else was asked for.
  const std::size_t each = factors == &own_ ? together : 1;
  for (std::size_t first = 0; first < wanted.size(); first += each) {
    const std::span<const std::size_t> some =
        std::span(wanted).subspan(first, std::min(each, wanted.size() - first));
    std::vector<std::vector<double>> columns;
    if (!find_columns(motion, ports, *factors->solver, some, columns)) return false;
    for (std::size_t k = 0; k < some.size(); ++k) known[some[k]] = std::move(columns[k]);
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::vector<double>& column = known[values[i]];
    for (std::size_t j = 0; j < values.size(); ++j) {
      out[i * values.size() + j] += 0.5 * column[values[j]];
      out[j * values.size() + i] += 0.5 * column[values[j]];
    }
  }
  return true;
}

void MidpointStep::bound(const Motion& motion, const PortMap& ports,
                         const std::vector<std::size_t>& values, std::vector<double>& out) {
  std::vector<double> unit(ports.values(), 0.0);
  Vector lifted, picked, masses;
  free_.pick(mass_, masses);
  out.clear();
  for (const std::size_t value : values) {
    const auto [known, fresh] = by_mass_.try_emplace(value, 0.0);
    if (fresh) {
      unit[value] = 1.0;
      lifted.setZero(mass_.size());
      ports.lift(motion.q, unit, lifted);
      unit[value] = 0.0;
      free_.pick(lifted, picked);
      known->second = 0.5 * picked.cwiseProduct(picked).cwiseQuotient(masses).sum();
    }
    out.push_back(known->second);
  }
}

}  // namespace abut
