#include "coordinator/energy_guard.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace abut {

namespace {
/// Bodies at rest that loads set in motion have hardly any energy at first.
constexpr int looks_from_rest = 10;
}  // namespace

EnergyGuard::EnergyGuard(double share, std::vector<bool> conserves, bool together,
                         std::vector<double> inertia)
    : share_(share),
      conserves_(std::move(conserves)),
      inertia_(std::move(inertia)),
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
    if (!begun_) account.first = here;
    if (begun_) {
      for (const PortResponse& port : responses[b].ports) account.ports += port.work;
    }
    account.change = here - account.first - account.ports - (struck.empty() ? 0.0 : struck[b]);
  }
  if (!std::exchange(begun_, true)) {
    first_ = own;
    unjudged_ = motion == 0.0 ? looks_from_rest : 0;
    most_ = unresolved(responses);
  }
  most_ = std::max(most_, motion);
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

double EnergyGuard::unresolved(std::span<const Response> responses) const {
  double energy = 0.0;
  for (std::size_t b = 0; b < inertia_.size(); ++b) {
    double most = 0.0;
    for (const PortResponse& port : responses[b].ports)
      most = std::max(most, port.acceleration_bound);
    energy += inertia_[b] * most * most;
  }
  return energy;
}

EnergyGuard::Verdict EnergyGuard::verdict(double change, double share, bool losses) {
  growth_ = change;
  if (change > share) return Verdict::fail;
  const bool notable = change > 0.5 * share || (losses && change < -share);
  return notable && !std::exchange(warned_, true) ? Verdict::warn : Verdict::fine;
}

}  // namespace abut
