#include "coordinator/passive/common_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace abut {

namespace {

constexpr int most_rounds = 14;  // of impulses and bodies' answers in a step
constexpr int most_checks = 6;   // of the ways
/// Of the thickness: rows that are missed by less fit.
constexpr double fits = 0.05;
/// The same of bodies without inertia: what stays open is force there.
constexpr double fits_at_rest = 1.0e-3;
/// [1/(thickness/step)] of velocities of rows: less is no change.
constexpr double negligible = 1.0e-3;
/// Of the largest energy: less work of impulses in a step, that velocities close, is none; it
/// may add up to a thousandth in a thousand steps. Of joined bodies rows are no finer than joints,
/// which hold to a share of the thickness.
constexpr double no_work = 1.0e-6;
/// Of both, where rows fit and pairs that they hold come too near all the same: those were nearer
/// than what fits.
constexpr double finer = 0.1;
/// Of the largest energy: the rounding of work.
constexpr double rounding_of_work = 1.0e-9;
/// What parts surfaces that are too near: this share of what they miss in a step, at most so many
/// edges in a nominal step, for at most this share of half of what normal contact has lost.
constexpr double push_share = 0.1, push_edges = 0.05, paid_share = 0.2;
/// [J] Bodies without inertia are pushed out whatever it takes.
constexpr double without_account = 1.0e200;
/// From this solve of the same rows on bodies count as softer, doubly each time: a model that is
/// too stiff throws impulses too far, one that is too soft comes slowly and surely.
constexpr int softer_from = 3, softest = 3;
/// Impulses below this share of those on a point are none.
constexpr double no_impulse = 1.0e-9;

/// Of the thickness: ties that are missed by less hold.
constexpr double holds = 1.0e-3;
/// The same with the forces of the step before, which they would keep for many steps: what they
/// part by would grow until it is a blow, at an instant that roundings choose.
constexpr double holds_at_once = 1.0e-6;
/// Of the largest energy: what ties may do in a step. They take back what sides part by, on which
/// their forces do some work, to and fro.
constexpr double work_of_ties = 1.0e-6;

std::vector<int> owners_of(const PassiveTies& ties, int bodies) {
  std::vector<int> owners;
  for (int b = 0; b < bodies; ++b) owners.push_back(ties.cluster(b));
  return owners;
}

}  // namespace

CommonStep::CommonStep(const TouchingSurfaces& surfaces, NearRows& near,
                       std::vector<PassiveTie> ties, Bodies& bodies, double nominal, bool statics)
    : surfaces_(surfaces),
      near_(near),
      bodies_(bodies),
      nominal_(nominal),
      statics_(statics),
      ties_(std::move(ties), bodies),
      points_(surfaces, owners_of(ties_, bodies.count())),
      asked_(index(bodies.count())),
      tried_(index(bodies.count())),
      replies_(index(bodies.count())),
      displacements_(index(bodies.count())),
      advanced_(index(bodies.count())),
      impacts_(surfaces, bodies),
      sliding_(surfaces),
      energies_(index(bodies.count())),
      accounts_(index(bodies.count())),
      port_work_(index(bodies.count())) {
  for (int b = 0; b < bodies.count(); ++b) pressing_.emplace_back(bodies.describe(b).ports.size());
}

std::optional<Failed> CommonStep::begin(double time) {
  step_.begin = step_.end = time;
  rows_.clear();
  warm_.clear();
  owed_.clear();
  impacts_.clear();
  sliding_.clear();
  points_.clear();
  std::ranges::fill(advanced_, 0);
  if (std::optional<Failed> failed = advance(true)) return failed;
  std::swap(replies_, tried_);
  surfaces_.move(replies_, surfaces_.reference(), from_);
  to_ = from_;
  near_.begin(from_);
  for (int b = 0; b < bodies_.count(); ++b) {
    const PassiveReply& reply = replies_[index(b)];
    energies_[index(b)] = own_energy(reply.record);
    displacements_[index(b)].clear();
    for (const PassiveReply::Port& port : reply.ports)
      displacements_[index(b)].push_back(port.displacement);
    port_work_[index(b)].assign(bodies_.describe(b).ports.size(), 0.0);
  }
  ties_.begin(displacements_);
  return std::nullopt;
}

double CommonStep::own_energy(const BodyRecord& record) {
  const Energy& e = record.energy;
  return e.kinetic + e.stored + e.dissipated - e.external_work;
}

double CommonStep::motion_of(std::span<const PassiveReply> replies) {
  double sum = 0.0;
  for (const PassiveReply& reply : replies) sum += reply.record.energy.total();
  return sum;
}

void CommonStep::lower(int body, double joules) { energies_[index(body)] -= joules; }

std::optional<CommonStep::Refusal> CommonStep::take(double begin, double end, bool lenient,
                                                    PassiveLedger& ledger) {
  step_.begin = begin;
  step_.end = end;
  rows_.clear();
  points_.clear();
  prepared_ = 0;
  softer_ = 0;
  released_ = returned_ = 0.0;
  culprit_ = -1;
  std::ranges::fill(advanced_, 0);
  see_start();
  credit_ = statics_ ? without_account : 0.5 * ledger.normal;
  const double budget = credit_ - ledger.push_out;
  lost_ = std::max(0.0, ledger.normal - ledger.push_out);
  pushing_ = budget > 0.0;
  allowed_ = paid_share * std::max(0.0, budget);
  unclaimed_ = affordable(owed_, ledger.normal - ledger.push_out);
  ties_.aim(length(), displacements_, replies_,
            work_of_ties * std::max(most_, motion_of(replies_)));
  near_.find(from_, rows_);
  prepare_rows();
  if (std::optional<Failed> failed = advance(true)) {
    why_ = failed->detail;
    return Refusal::body;
  }
  see_velocities();
  near_.find_on_ways(from_, to_, rows_);
  impacts_.aim(rows_, start_, velocities_, ties_);
  if (std::optional<Refusal> refused = iterate()) return refused;
  if (farthest_of(tried_) > most_way_) return Refusal::path;
  return accept(lenient, ledger);
}

std::string CommonStep::driven() const {
  // They may be those of the last trial to which all bodies had an answer; or there was none.
  if (velocities_.size() != from_.size()) return {};
  const auto moves = [this](const DistanceRow& row) {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::int32_t point = row.features.points[i];
      if (!row.counts(i) || points_.slot(point) < 0) continue;
      const std::optional<double> own = points_.of_its_own(point);
      if (!own || *own > 0.0) return true;  // not told, or it gives way
    }
    return false;
  };
  const double still = negligible * near_.thickness() / length();
  for (const DistanceRow& row : rows_) {
    if (row_velocity(row, velocities_, 0) >= row.least() - still || moves(row)) continue;
    const auto name = [&](int side) {
      return bodies_.describe(surfaces_[row.first_point(side)].body).name;
    };
    const Eigen::Vector3d& at = from_[index(row.first_point(0))];
    return fmt::format(
        "supports and tools drive '{}' and '{}' onto each other near ({:.4g}) m, and nothing gives "
        "way there: let them end earlier, or elsewhere",
        name(0), name(1), fmt::join(at.data(), at.data() + surfaces_.skin().dim, ", "));
  }
  return {};
}

bool CommonStep::settle(double begin, double end, int looser, double most_way, bool lenient,
                        PassiveLedger& ledger) {
  std::vector<DistanceRow> rows = rows_;
  looser_ = looser;
  most_way_ = most_way;
  const bool taken = !take(begin, end, lenient, ledger);
  looser_ = 0;
  most_way_ = std::numeric_limits<double>::infinity();
  if (taken) return true;
  rows_ = std::move(rows);
  return false;
}

/// Impulses, the bodies' answers, and again, until rows fit and the ways are free. What the bodies
/// do freely is the first answer where they told of all points that are pressed then.
std::optional<CommonStep::Refusal> CommonStep::iterate() {
  int checks = 0;
  fine_ = 1.0;
  const double fit = (statics_ ? fits_at_rest : fits) * near_.thickness();
  if (rows_.empty() && ties_fit(holds_at_once) && near_.check(from_, to_, rows_).pairs == 0)
    return std::nullopt;
  for (int round = 0; round < most_rounds; ++round) {
    const bool last = round + 1 == most_rounds;
    const bool told = !prepare_rows();
    if (round == 0 && told) {
      solve_rows(0);
      continue;
    }
    if (std::optional<Failed> failed = advance(false)) {
      why_ = failed->detail;
      return Refusal::body;
    }
    see_velocities();
    double unfit = 0.0, work = 0.0;
    rows_ask(unfit, work);
    const std::size_t known = rows_.size();
    if (round > 0 && ((unfit < fine_ * fit && ties_fit(fine_ * holds)) || last)) {
      if (work <= most_work() + rounding_of_work * most_ && ties_.passive()) {
        const NearRows::Crossed crossed = near_.check(from_, to_, rows_);
        if (crossed.pairs == 0) return std::nullopt;
        if (last || ++checks > most_checks) {
          why_ = fmt::format("{} pairs of features come too near", crossed.pairs);
          return last ? Refusal::rows : Refusal::path;
        }
        softer_ = 0;
        if (crossed.added == 0) fine_ *= finer;
      } else if (last) {
        why_ = fmt::format("contact would do {:.3g} J, and ties {:.3g} J", work, ties_.work());
        return Refusal::work;
      }
    }
    if (prepare_rows()) continue;  // the bodies have not told of their points
    solve_rows(known);
  }
  why_ = "no impulses were found that fit";
  return Refusal::rows;
}

/// True: some press on points that the bodies have not told of.
bool CommonStep::prepare_rows() {
  bool grown = false;
  const double h = length(), least = push_edges * surfaces_.shortest_edge() / nominal_;
  for (; prepared_ < rows_.size(); ++prepared_) {
    DistanceRow& row = rows_[prepared_];
    const double missing = near_.thickness() - row.gap;
    const double share = statics_ ? 1.0 : push_share;  // nothing bounces
    row.push = pushing_ && missing > 0.0 ? std::min(share * missing / h, least) : 0.0;
    row.closing = missing < 0.0 ? -missing / h : -row.push;
    give_friction(row);
    warm(row);
    if (const auto owed = unclaimed_.extract(row.first_point(0))) row.owed = owed.mapped();
    grown = points_.add(row) || grown;
  }
  if (grown) points_.number();
  claim_of_others();
  return grown;
}

/// What is owed to points that begin no row now goes to a row that presses on them: a corner has
/// slid from one facet to the next, or it is the facet's corner that is held.
void CommonStep::claim_of_others() {
  for (DistanceRow& row : rows_) {
    if (unclaimed_.empty()) return;
    for (std::size_t i = 0; i < 4; ++i) {
      if (row.weights[i] == 0.0) continue;
      if (const auto owed = unclaimed_.extract(row.features.points[i])) row.owed += owed.mapped();
    }
  }
}

/// From the impulse of the same features in the step before.
void CommonStep::warm(DistanceRow& row) {
  const auto found = warm_.find(row.key());
  if (found == warm_.end()) return;
  const Eigen::Vector3d before = found->second;
  row.normal_impulse = std::max(0.0, before.dot(row.normal));
  if (row.friction > 0.0) {
    for (const std::size_t t : {0u, 1u}) row.tangential_impulse[t] = before.dot(row.tangents[t]);
    const double length = std::hypot(row.tangential_impulse[0], row.tangential_impulse[1]);
    const double most = row.friction * row.normal_impulse;
    if (length > most)
      for (double& value : row.tangential_impulse) value *= most / length;
  }
}

/// Bodies that rows press on, from where the step begins; all of them, without impulses, first.
std::optional<Failed> CommonStep::advance(bool all) {
  find_impulses(!all);
  std::vector<int> moved;
  for (int b = 0; b < bodies_.count(); ++b) {
    PassiveStep& asked = asked_[index(b)];
    const bool touched = std::ranges::any_of(
        asked.impulses, [](const std::vector<double>& port) { return !port.empty(); });
    if (!all && !touched && !ties_.joined(b) && !points_.any(b)) continue;
    asked.again = advanced_[index(b)] != 0;
    if (asked.again) bodies_[b].restore();
    advanced_[index(b)] = 1;
    asked.begin = step_.begin;
    asked.end = step_.end;
    asked.looser = looser_;
    asked.pressed = points_.list(b, bodies_.describe(b).ports.size());
    if (length() > 0.0) ties_.add_points(b, asked.pressed);
    bodies_.ask_passively(b).start(asked);
    moved.push_back(b);
  }
  std::optional<Failed> first;
  for (const int b : moved) {
    Outcome outcome = bodies_[b].passive()->finish(tried_[index(b)]);
    bodies_.add_compute(b, tried_[index(b)].compute_seconds);
    if (Failed* failed = std::get_if<Failed>(&outcome); failed != nullptr && !first) {
      culprit_ = b;
      first = Failed{failed->cause, failed->time,
                     fmt::format("body '{}': {}", bodies_.describe(b).name, failed->detail)};
    }
  }
  return first;
}

/// Of all rows, or none of them, and of ties, by body, port and point.
void CommonStep::find_impulses(bool any) {
  press_rows(any);
  for (int b = 0; b < bodies_.count(); ++b) {
    asked_[index(b)].impulses = pressing_[index(b)];
    ties_.add_impulses(b, asked_[index(b)].impulses);
  }
}

void CommonStep::press_rows(bool any) {
  for (auto& ports : pressing_)
    for (std::vector<double>& port : ports) port.clear();
  if (!any) return;
  const int dim = surfaces_.skin().dim;
  for (const DistanceRow& row : rows_) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (!row.counts(i)) continue;
      const Eigen::Vector3d impulse = row.impulse_on(i);
      const TouchingSurfaces::Point& at = surfaces_[row.features.points[i]];
      std::vector<double>& port = pressing_[index(at.body)][index(at.port)];
      if (port.empty())
        port.assign(bodies_.describe(at.body).ports[at.port].geometry.points.size(), 0.0);
      for (int k = 0; k < dim; ++k) port[index(at.point) * index(dim) + index(k)] += impulse(k);
    }
  }
}

void CommonStep::see_velocities() {
  surfaces_.move(tried_, from_, to_);
  velocities_.assign(to_.size(), Eigen::Vector3d::Zero());
  surfaces_.move(tried_, velocities_, velocities_);
  for (Eigen::Vector3d& velocity : velocities_) velocity /= length();
  ties_.see(tried_, asked_);
}

bool CommonStep::ties_fit(double most) const {
  return !ties_.any() || (ties_.missed() < most * near_.thickness() && ties_.passive());
}

/// By how much rows are missed at most [m], those that press and need not a tenth; and what their
/// impulses do [J].
void CommonStep::rows_ask(double& unfit, double& work) const {
  double largest = 0.0;
  for (const DistanceRow& row : rows_) largest = std::max(largest, row.normal_impulse);
  for (const DistanceRow& row : rows_) {
    const double w = row_velocity(row, velocities_, 0);
    work += row.normal_impulse * w;
    for (const std::size_t t : {0u, 1u})
      if (row.tangential_impulse[t] != 0.0)
        work += row.tangential_impulse[t] * row_velocity(row, velocities_, static_cast<int>(t) + 1);
    const double over = (w - row.least()) * length();
    unfit = std::max(unfit, -over);
    const bool pulls = row.aimed && row.normal_impulse > -row.pushed;
    if (pulls || row.normal_impulse > no_impulse * largest)
      unfit = std::max(unfit, 0.1 * std::abs(over));
  }
}

/// [J] of contact in the step: push-out's part, or, where rows give back what they took, no more
/// than all that is lost.
double CommonStep::most_work() const {
  const double normal =
      released_ > 0.0 ? std::min(allowed_ + released_, credit_ + allowed_ / paid_share) : allowed_;
  return normal + returned_;
}

/// The bodies answered under the impulses of so many of the rows.
void CommonStep::solve_rows(std::size_t answered) {
  const int doubled = std::clamp(softer_ - softer_from, 0, softest);
  for (int b = 0; b < bodies_.count(); ++b) take_answer(b, std::ldexp(1.0, doubled));
  const RowImpulses::Negligible still = {
      fine_ * (statics_ ? fits_at_rest : 1.0) * negligible * near_.thickness() / length(),
      ties_.any() ? std::numeric_limits<double>::infinity() : no_work * most_, statics_};
  const double rounding = 1.0e-3 * rounding_of_work * most_;
  RowImpulses solver(rows_, points_, surfaces_, velocities_);
  solver.press_from(answered);
  solver.solve(still);
  released_ = solver.release(still);
  if (const double parted = solver.parted(); parted > 0.0)
    released_ = std::min(released_ + parted, lost_);
  const double there = credit_ + allowed_ / paid_share;  // [J] of normal contact, while pushing
  returned_ = solver.returned();
  const bool dear =
      solver.work() - returned_ > allowed_ + released_ + rounding || allowed_ + released_ > there;
  if (pushing_ && dear) {
    pushing_ = false;
    for (DistanceRow& row : rows_) row.closing = std::max(row.closing, 0.0), row.push = 0.0;
    solver.solve(still);
  }
  const double most = (pushing_ ? allowed_ : 0.0) + released_ + returned_;
  if (solver.work() > most + rounding) solver.limit(most);
  for (DistanceRow& row : rows_)
    if (row.recoils) row.push = solver.velocity(row);
  if (ties_.any()) follow_ties();
  ++softer_;
}

/// How a body, or the cluster that it leads, answers impulses of rows.
void CommonStep::take_answer(int owner, double softer) {
  if (ties_.cluster(owner) != owner) return;
  if (!ties_.joined(owner)) {
    if (points_.any(owner)) points_.take(owner, tried_[index(owner)], softer, velocities_);
    return;
  }
  const PassiveTies::Answer answer = ties_.answer(owner, points_.values(owner));
  if (!points_.any(owner)) return;
  points_.take(owner, answer.compliance, softer, velocities_);
  points_.velocity(owner) += answer.change;
}

/// By what rows press on now beside the impulses that the bodies have answered.
void CommonStep::follow_ties() {
  const auto before = pressing_;
  press_rows(true);
  const std::size_t dim = index(surfaces_.skin().dim);
  for (int b = 0; b < bodies_.count(); ++b) {
    if (ties_.cluster(b) != b || !ties_.joined(b)) continue;
    std::vector<double> change;
    for (const auto& [body, port, point] : points_.values(b)) {
      const std::vector<double>& now = pressing_[index(body)][index(port)];
      const std::vector<double>& then = before[index(body)][index(port)];
      for (std::size_t i = 0; i < dim; ++i) {
        const std::size_t v = index(point) * dim + i;
        change.push_back((now.empty() ? 0.0 : now[v]) - (then.empty() ? 0.0 : then[v]));
      }
    }
    ties_.follow(b, Eigen::Map<const Eigen::VectorXd>(change.data(),
                                                      static_cast<Eigen::Index>(change.size())));
  }
}

}  // namespace abut
