// What a step that was taken did to the accounts: of every body, of rows, of the ledger.

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "coordinator/passive/common_step.hpp"

namespace abut {

namespace {

/// Of the largest energy: what a step's account may gain before the step is refused.
constexpr double most_gain = 1.0e-3;
/// Of what normal impulses took: what rows give back as they part. The rest is for the rounding of
/// work; of bodies that answer otherwise than was foreseen impulses are sought again.
constexpr double given_back = 0.9998;
/// Speeds that loads make in so many steps are no blows.
constexpr double steps_of_loads = 2.0;
/// Thicknesses: sides that begin a step farther from each other do not press there, and meet within
/// it.
constexpr double apart = 3.0;
/// Of the shortest edge: points less deep behind a surface are on it.
constexpr double rounding_of_places = 1.0e-6;

/// [m/s] of a row's sides along each other.
double along_of(const DistanceRow& row, std::span<const Eigen::Vector3d> velocities) {
  return std::hypot(row_velocity(row, velocities, 1), row_velocity(row, velocities, 2));
}

}  // namespace

/// Debts to rows [J], all cut alike to what there is: what was paid to part what is too near is not
/// given back.
CommonStep::Debts CommonStep::affordable(Debts debts, double there) {
  double owed = 0.0;
  for (const auto& [point, joules] : debts) owed += joules;
  if (owed <= there) return debts;
  for (auto& [point, joules] : debts) joules *= std::max(0.0, there) / owed;
  return debts;
}

/// The account of every body: what its energy gained beside what its ports did.
std::optional<CommonStep::Refusal> CommonStep::accept(bool lenient, PassiveLedger& ledger) {
  share_out_work();
  const double scale = std::max(most_, motion_of(tried_));
  std::vector<double> gained(accounts_.size());
  for (int b = 0; b < bodies_.count(); ++b) {
    double done = 0.0;
    for (const double work : port_work_[index(b)]) done += work;
    gained[index(b)] = own_energy(tried_[index(b)].record) - energies_[index(b)] - done;
    // Forces of statics are those of a step's end, and so is the work that is told of them.
    const bool gains = !lenient && !statics_ && gained[index(b)] > most_gain * scale;
    if (!std::isfinite(gained[index(b)]) || gains) {
      why_ =
          fmt::format("body '{}' would gain {:.3g} J", bodies_.describe(b).name, gained[index(b)]);
      culprit_ = b;
      return Refusal::energy;
    }
  }
  most_ = scale;
  ties_.accept();
  ledger.switched -= ties_.work();
  std::swap(replies_, tried_);
  from_ = to_;
  near_.accept(from_);
  for (int b = 0; b < bodies_.count(); ++b)
    for (std::size_t p = 0; p < displacements_[index(b)].size(); ++p)
      for (std::size_t k = 0; k < displacements_[index(b)][p].size(); ++k)
        displacements_[index(b)][p][k] += replies_[index(b)].ports[p].displacement[k];
  for (int b = 0; b < bodies_.count(); ++b) {
    double& account = accounts_[index(b)];
    account += gained[index(b)];
    double taken = 0.0;
    if (account > 0.0 && gained[index(b)] > 0.0 && std::isfinite(bodies_.describe(b).mass))
      taken = bodies_.ask_passively(b).damp(account);
    account -= taken;
    ledger.taken_back += taken;
    if (taken != 0.0) PassiveLedger::add(ledger.taken, b, taken);
    replies_[index(b)].record.energy.kinetic -= taken;
    energies_[index(b)] = own_energy(replies_[index(b)].record);
  }
  warm_.clear();
  owed_.clear();
  for (const DistanceRow& row : rows_) {
    count_normal(row, ledger);
    count_friction(row, ledger);
    sliding_.see(row, along_of(row, velocities_), speed_of_rest());
    if (row.normal_impulse > 0.0) warm_[row.key()] = row.impulse();
    if (row.behind && -row.gap > rounding_of_places * surfaces_.shortest_edge())
      ledger.deepest = std::max(ledger.deepest, -row.gap);
  }
  impacts_.next_step();
  sliding_.next_step();
  ledger.owed = 0.0;
  if (statics_) return std::nullopt;
  for (const auto& [point, joules] : affordable(owed_, ledger.normal - ledger.push_out))
    ledger.owed += joules;
  return std::nullopt;
}

/// What a row took is lost until it gives it back, as long as it stays near; what rigid bodies lose
/// is what restitution says.
void CommonStep::count_normal(const DistanceRow& row, PassiveLedger& ledger) {
  const double velocity = row_velocity(row, velocities_, 0), work = row.normal_impulse * velocity;
  if (work > 0.0 && !row.recoils && !row.aimed) {
    ledger.push_out += work;
  } else {
    ledger.normal -= work;
    share_out_loss(row, -work, ledger);
  }
  double approach = 0.0;
  const bool pressed = row.normal_impulse > 0.0, blow = pressed && is_blow(row, approach);
  if (impacts_.are_rigid(row)) {
    ledger.impacts -= work;
    if (row.aimed) {
      const double end = 2.0 * velocity - row_velocity(row, start_, 0);
      const bool rests = std::abs(end - row.parting) <= speed_of_loads(row);
      if (!rests) impacts_.follow(row, velocity, heat_of(row));
      return;
    }
    if (blow) impacts_.begin(row, approach, heat_of(row));
    return;
  }
  const double taken = work < 0.0 && blow ? -work : 0.0;
  const double owed = row.recoils ? 0.0 : row.owed + given_back * taken;
  if (owed > 0.0 && !row.behind && surfaces_.skin().dim > 1) owed_[row.first_point(0)] += owed;
}

/// Whether its sides came, at `approach` [m/s], faster than loads make them in a few steps: what
/// comes slower lies down. Without loads sides that meet within the step count, too, whatever they
/// did at its begin.
bool CommonStep::is_blow(const DistanceRow& row, double& approach) const {
  approach = -row_velocity(row, start_, 0);
  double speed = approach;  // [m/s]
  const double loads = speed_of_loads(row);
  if (loads == 0.0 && row.gap > apart * near_.thickness())  // nothing has to lie down
    speed = std::max(speed, -row_velocity(row, velocities_, 0));
  return speed > loads;
}

/// [m/s] that loads make of what rests, in a few steps.
double CommonStep::speed_of_loads(const DistanceRow& row) const {
  double loads = 0.0;  // [m/s^2]
  for (const int side : {0, 1}) {
    const TouchingSurfaces::Point& at = surfaces_[row.first_point(side)];
    loads += bodies_.response(at.body).ports[index(at.port)].acceleration_bound;
  }
  return steps_of_loads * loads * length();
}

double CommonStep::farthest() const { return farthest_of(replies_); }

double CommonStep::farthest_of(std::span<const PassiveReply> replies) {
  double most = 0.0;
  for (const PassiveReply& reply : replies)
    for (const PassiveReply::Port& port : reply.ports)
      for (const double moved : port.displacement) most = std::max(most, std::abs(moved));
  return most;
}

double CommonStep::held() const {
  double most = 0.0;
  for (const PassiveReply& reply : replies_) most = std::max(most, reply.held);
  return most;
}

/// [m/s] of all points where the step begins.
void CommonStep::see_start() {
  const std::size_t dim = index(surfaces_.skin().dim);
  start_.assign(surfaces_.count(), Eigen::Vector3d::Zero());
  for (std::size_t p = 0; p < start_.size(); ++p) {
    const TouchingSurfaces::Point& at = surfaces_[static_cast<std::int32_t>(p)];
    const std::vector<double>& of = replies_[index(at.body)].ports[index(at.port)].velocity;
    for (std::size_t k = 0; k < dim; ++k)
      start_[p](static_cast<Eigen::Index>(k)) = of[index(at.point) * dim + k];
  }
}

/// [m/s] of sides along each other that stick: what sweeps leave.
double CommonStep::speed_of_rest() const {
  return rounding_of_places * surfaces_.shortest_edge() / length();
}

void CommonStep::give_friction(DistanceRow& row) const {
  if (!(row.friction > 0.0)) return;
  row.friction = sliding_.coefficient(row, along_of(row, start_), speed_of_rest());
}

/// [J] that friction took in the step.
double CommonStep::heat_of(const DistanceRow& row) const {
  double heat = 0.0;
  for (const std::size_t t : {0u, 1u})
    heat -= row.tangential_impulse[t] * row_velocity(row, velocities_, static_cast<int>(t) + 1);
  return heat;
}

/// What sticks moves by what its bodies' answers leave open, and its force may do work then: no
/// friction does, so normal contact has to have lost it, as what it pushes out.
void CommonStep::count_friction(const DistanceRow& row, PassiveLedger& ledger) const {
  const double heat = heat_of(row);
  if (heat < 0.0 && !row.aimed) ledger.push_out -= heat;
  if (!(heat > 0.0) && !row.aimed) return;
  ledger.friction += heat;
  const TouchingSurfaces::Point& one = surfaces_[row.first_point(0)];
  const TouchingSurfaces::Point& other = surfaces_[row.first_point(1)];
  ledger.rubbed[PassiveLedger::pair_of(one.body, one.port, other.body, other.port)] += heat;
}

/// Half of it to either side that deforms: a finer mesh there would lose less.
void CommonStep::share_out_loss(const DistanceRow& row, double loss, PassiveLedger& ledger) const {
  std::array<int, 2> sides{-1, -1};
  int deforming = 0;
  for (const std::size_t s : {0u, 1u}) {
    const TouchingSurfaces::Point& at = surfaces_[row.first_point(static_cast<int>(s))];
    if (!(bodies_.port({at.body, at.port}).geometry.transit > 0.0)) continue;  // rigid
    sides[s] = at.body;
    ++deforming;
  }
  for (const int body : sides)
    if (body >= 0) PassiveLedger::add(ledger.lost, body, loss / deforming);
}

/// [J] of impulses at the mean velocities of the points that they push.
void CommonStep::share_out_work() {
  for (std::vector<double>& ports : port_work_) std::ranges::fill(ports, 0.0);
  for (const DistanceRow& row : rows_) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (!row.counts(i)) continue;
      const std::int32_t point = row.features.points[i];
      const TouchingSurfaces::Point& at = surfaces_[point];
      port_work_[index(at.body)][index(at.port)] +=
          row.impulse_on(i).dot(velocities_[index(point)]);
    }
  }
  share_out_ties();
}

/// Of ties, whose ports no rows press on, and of those on which both do.
void CommonStep::share_out_ties() {
  for (int b = 0; b < bodies_.count() && ties_.any(); ++b) {
    std::vector<std::vector<double>> impulses(port_work_[index(b)].size());
    ties_.add_impulses(b, impulses);
    for (std::size_t p = 0; p < impulses.size(); ++p) {
      const std::vector<double>& moved = tried_[index(b)].ports[p].displacement;
      for (std::size_t v = 0; v < impulses[p].size(); ++v)
        port_work_[index(b)][p] += impulses[p][v] * moved[v] / length();
    }
  }
}

}  // namespace abut
