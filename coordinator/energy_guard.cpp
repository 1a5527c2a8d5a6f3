#include "coordinator/energy_guard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/index.hpp"

namespace abut {

namespace {
/// Bodies at rest that loads set in motion have hardly any energy at first.
constexpr int looks_from_rest = 10;
/// Of all there is in motion: what tools have done at least where it can be judged from the first
/// window on, and of what steps do not resolve, m (2 dt a)^2/2, how often it must be there.
constexpr double by_tools = 0.5, resolved_from_rest = 25.0;
/// Growth that a window may lead to where it can be gone another way: turning normals, unlike steps
/// and roles make some thousandths in scenes that the passive way would cost far more. Above it,
/// the part of a share [M.21].
constexpr double granted = 5.0e-3, part_of_share = 0.1;
/// What contact may take in a window, in units of that: a fiftieth of the energy.
constexpr double taken = 4.0;
/// Of a share: growth that stays. Of the default that is below a thousandth of the energy, which
/// nobody wants, as records within a window come before what is taken back at its end.
constexpr double stands = 0.08;
/// Of a share: what may stay beyond that, so that growth stays below a thousandth.
constexpr double spare = 0.01;
/// Of a share: what is told, and what one window may gain. Contact that dips and comes back stays
/// below: 0.2 of it where a block lands, 0.02 where balls roll.
constexpr double notable = 0.5;
/// Of all there is in motion: what the first window of bodies from rest may not make, though it is
/// too early to judge it closely: gaps that are means over coarse facets press before surfaces
/// touch, which was a tenth where ten blocks are set on each other. It falls with the square of the
/// looks that are left to what ends the run after them.
constexpr double out_of_nothing = 0.2;
/// Roundings of a place that may go into the velocity of a body: 16 in the sums of each step, and
/// those of a million steps add up by chance, to the root of that.
constexpr double roundings = 16.0e3;

/// [J] done by bodies that hold no energy: tools.
double work_of_tools(std::span<const Response> responses) {
  double work = 0.0;
  for (const Response& response : responses) {
    const Energy& energy = response.records.back().energy;
    if (energy.kinetic == 0.0 && energy.stored == 0.0) work += energy.external_work;
  }
  return work;
}

/// Whether bodies that began at rest have hardly any energy yet, or loads have made it.
bool too_early(std::span<const Response> responses, double motion, double unresolved) {
  return motion <= resolved_from_rest * unresolved || work_of_tools(responses) < by_tools * motion;
}
}  // namespace

EnergyGuard::EnergyGuard(double share, std::vector<bool> conserves, bool together,
                         std::vector<Stepping> stepping)
    : share_(share),
      conserves_(std::move(conserves)),
      stepping_(std::move(stepping)),
      all_conserve_(std::ranges::all_of(conserves_, [](bool yes) { return yes; })),
      together_(together),
      bodies_(conserves_.size()) {}

EnergyGuard::Verdict EnergyGuard::look(std::span<const Response> responses,
                                       std::span<const double> struck) {
  double own = 0.0, motion = 0.0;
  for (std::size_t b = 0; b < responses.size(); ++b) {
    const Energy& energy = responses[b].records.back().energy;
    const double here = energy.total() + energy.dissipated - energy.external_work;
    own += here;
    motion += energy.kinetic + energy.stored;
    Account& account = bodies_[b];
    const double ahead = struck.empty() ? 0.0 : struck[b];
    if (!begun_) account.first = here - ahead;
    if (begun_) {
      for (const PortResponse& port : responses[b].ports) account.ports += port.work;
    }
    account.change = here - account.first - account.ports - ahead;
  }
  const double rounded = rounding(responses);
  latest_ = own;
  if (!std::exchange(begun_, true)) {
    first_ = own;
    unjudged_ = motion <= rounded ? looks_from_rest : 0;
    most_ = unresolved(responses);
    most_touching_ = std::max(motion, rounded);
  }
  most_ = std::max({most_, motion, rounded});
  if (most_ <= 0.0 || unjudged_-- > 0) return Verdict::fine;
  unjudged_ = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const double change = bodies_[b].change / most_;
    if (!conserves_[b] || std::abs(change) <= share_) continue;
    culprit_ = static_cast<int>(b);
    return verdict(change, share_, true);
  }
  culprit_ = -1;
  if (!together_) return Verdict::fine;
  return verdict((own - first_) / most_, share_, all_conserve_);
}

/// [J] of all bodies together, so many records before the end; `motion`: the kinetic and stored
/// part. A body that stands may have told fewer.
double EnergyGuard::own_energy(std::span<const Response> responses, std::size_t before_end,
                               double& motion) const {
  double own = 0.0;
  motion = 0.0;
  for (const Response& response : responses) {
    const std::size_t last = response.records.size() - 1;
    const Energy& energy = response.records[last - std::min(before_end, last)].energy;
    own += energy.total() + energy.dissipated - energy.external_work;
    motion += energy.kinetic + energy.stored;
  }
  return own;
}

double EnergyGuard::bound() const {
  return std::max(std::min(share_, granted), part_of_share * share_);
}

/// At the end, less what impulses did.
double EnergyGuard::own_energy(std::span<const Response> responses, std::span<const double> struck,
                               double& motion) const {
  double own = own_energy(responses, 0, motion);
  for (const double joules : struck) own -= joules;
  return own;
}

bool EnergyGuard::refuses(std::span<const Response> responses,
                          std::span<const double> struck) const {
  if (!begun_ || !together_) return false;
  double motion = 0.0;
  const double own = own_energy(responses, struck, motion);
  // That of leapfrog, v- M v+/2, dips where a step turns velocities; by more than there is it
  // cannot.
  for (const Response& response : responses)
    if (response.records.back().energy.kinetic < -std::max(most_, motion)) return true;
  return gains(responses, own, own - latest_, motion);
}

bool EnergyGuard::refuses_flight(std::span<const Response> responses, int window) const {
  if (!begun_ || !together_) return false;
  std::size_t records = 0;
  for (const Response& response : responses) records = std::max(records, response.records.size());
  double before = latest_, motion = 0.0;
  for (std::size_t told = index(window); told < records; told += index(window)) {
    const double own = own_energy(responses, records - told, motion);
    if (gains(responses, own, own - before, motion)) return true;
    before = own;
  }
  return refuses(responses);
}

/// [J] `own`: all energy, `more`: by how much it has grown in a window.
bool EnergyGuard::gains(std::span<const Response> responses, double own, double more,
                        double motion) const {
  const double scale = std::max(most_, motion);
  const double small = std::max(unresolved(responses), rounding(responses));
  if (unjudged_ > 0 && too_early(responses, motion, small)) {
    const double left = unjudged_ / static_cast<double>(looks_from_rest);
    return own - first_ > (bound() + out_of_nothing * left * left) * scale;
  }
  const double at_once = std::max(bound(), notable * share_);
  return own + repaid_ - first_ > bound() * scale || more > at_once * scale;
}

bool EnergyGuard::loses(std::span<const Response> responses, double to_contact,
                        std::span<const double> struck) const {
  if (!begun_ || !together_ || unjudged_ > 0) return false;
  double motion = 0.0;
  const double own = own_energy(responses, struck, motion);
  double passed = std::max(most_, motion);  // [J] that contact may have passed on
  for (const Response& response : responses)
    passed = std::max(passed, std::abs(response.records.back().energy.external_work));
  return std::min(to_contact, latest_ - own) > taken * bound() * passed;
}

bool EnergyGuard::ends(std::span<const Response> responses, double payments) const {
  if (!begun_ || !together_ || unjudged_ > 0) return false;
  double motion = 0.0;
  const double own = own_energy(responses, {}, motion) + payments;
  return own - first_ > share_ * std::max(most_, motion);
}

double EnergyGuard::excess(std::span<const Response> responses, std::span<const double> struck,
                           double payments) {
  if (!begun_ || !together_) return 0.0;
  double motion = 0.0;
  const double own = own_energy(responses, struck, motion) + payments;
  const double small = std::max(unresolved(responses), rounding(responses));
  if (unjudged_ > 0 && too_early(responses, motion, small)) return 0.0;
  most_touching_ = std::max(most_touching_, motion);
  for (const Response& response : responses)
    most_touching_ =
        std::max(most_touching_, std::abs(response.records.back().energy.external_work));
  return std::max(0.0, own - first_ - stands * share_ * most_touching_);
}

double EnergyGuard::overgrown(std::span<const Response> responses) const {
  if (!begun_ || !together_) return 0.0;
  double motion = 0.0;
  const double own = own_energy(responses, 0, motion);
  return std::max(0.0, own - first_ - bound() * std::max(most_, motion));
}

double EnergyGuard::forgiven() const { return spare * share_ * most_touching_; }

void EnergyGuard::repaid(int body, double joules) {
  bodies_[static_cast<std::size_t>(body)].ports -= joules;
  repaid_ += joules;
}

void EnergyGuard::struck(std::span<const Response> responses) {
  for (std::size_t b = 0; b < responses.size(); ++b)
    for (const PortResponse& port : responses[b].ports) bodies_[b].ports += port.work;
}

double EnergyGuard::unexplained(int body) const {
  return begun_ && together_ ? bodies_[static_cast<std::size_t>(body)].change : 0.0;
}

/// m (2 dt a)^2/2: of what a body moves at after two steps under its body force.
double EnergyGuard::unresolved(std::span<const Response> responses) const {
  double energy = 0.0;
  for (std::size_t b = 0; b < stepping_.size(); ++b) {
    double most = 0.0;
    for (const PortResponse& port : responses[b].ports)
      most = std::max(most, port.acceleration_bound);
    const double speed = 2.0 * stepping_[b].step * most;
    energy += 0.5 * stepping_[b].mass * speed * speed;
  }
  return energy;
}

/// m v^2/2, of velocities by which the rounding of places may go astray.
double EnergyGuard::rounding(std::span<const Response> responses) const {
  double energy = 0.0;
  for (std::size_t b = 0; b < stepping_.size(); ++b) {
    if (!(stepping_[b].step > 0.0)) continue;
    double farthest = 0.0;  // [m]
    for (const PortResponse& port : responses[b].ports) {
      for (const double place : port.lower) farthest = std::max(farthest, std::abs(place));
      for (const double place : port.upper) farthest = std::max(farthest, std::abs(place));
    }
    const double speed =
        roundings * std::numeric_limits<double>::epsilon() * farthest / stepping_[b].step;
    energy += 0.5 * stepping_[b].mass * speed * speed;
  }
  return energy;
}

EnergyGuard::Verdict EnergyGuard::verdict(double change, double share, bool losses) {
  growth_ = change;
  if (change > share) return Verdict::fail;
  const bool told = change > notable * share || (losses && change < -share);
  return told && !std::exchange(warned_, true) ? Verdict::warn : Verdict::fine;
}

void EnergyGuard::Account::state(Archive& archive) {
  archive.field("first", first);
  archive.field("ports", ports);
  archive.field("change", change);
}

void EnergyGuard::state(Archive& archive) {
  archive.field("begun", begun_);
  archive.field("warned", warned_);
  std::int64_t unjudged = unjudged_, count = static_cast<std::int64_t>(bodies_.size());
  archive.field("unjudged", unjudged);
  archive.field("accounts", count);
  unjudged_ = static_cast<int>(unjudged);
  bodies_.resize(static_cast<std::size_t>(count));
  for (Account& account : bodies_) account.state(archive);
  archive.field("first", first_);
  archive.field("latest", latest_);
  archive.field("most", most_);
  archive.field("repaid", repaid_);
  archive.field("most_touching", most_touching_);
  archive.field("growth", growth_);
}

}  // namespace abut
